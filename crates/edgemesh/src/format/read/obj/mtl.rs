//! MTL, the text of a material library.
//!
//! Source: Alias|Wavefront, *Advanced Visualizer Manual*, appendix B2, and what
//! programs write. A statement that makes no sense is ignored: a material library
//! never stops the geometry.

use std::ops::Range;

use crate::format::read::number::parse_number;
use crate::model::Material;

/// The name of a material whose `newmtl` has none.
const UNNAMED: &str = "(unnamed)";

/// A material of a library.
#[derive(Debug)]
pub(super) struct LibraryMaterial {
    /// Its name and numbers, without a texture.
    pub(super) material: Material,
    /// What follows `map_Kd`: options, then the name of a file.
    pub(super) diffuse_map: Option<String>,
}

/// The materials of a library, in its order; of several statements of one kind the
/// last one counts.
///
/// A color of one number is gray. `Tr`, the transparency, is 1 - `d`.
pub(super) fn parse_mtl(text: &str) -> Vec<LibraryMaterial> {
    let mut materials: Vec<LibraryMaterial> = Vec::new();
    for line in text.lines() {
        let (keyword, rest) = split_word(line.trim());
        if keyword == "newmtl" {
            let name = if rest.is_empty() { UNNAMED } else { rest };
            let material = Material { name: name.into(), ..Material::default() };
            materials.push(LibraryMaterial { material, diffuse_map: None });
        } else if let Some(current) = materials.last_mut() {
            current.add_statement(keyword, rest);
        }
    }
    materials
}

impl LibraryMaterial {
    fn add_statement(&mut self, keyword: &str, rest: &str) {
        let Self { material, diffuse_map } = self;
        let numbers: Vec<f32> = rest.split_whitespace().map_while(number_of).collect();
        let number = numbers.first().copied();
        let color = match *numbers {
            [red, green, blue, ..] => Some([red, green, blue]),
            [gray] => Some([gray; 3]),
            _ => None,
        };
        match keyword {
            "Ka" => material.ambient = color.or(material.ambient),
            "Kd" => material.diffuse = color.or(material.diffuse),
            "Ks" => material.specular = color.or(material.specular),
            "Ns" => material.shininess = number.or(material.shininess),
            "d" => material.opacity = number.or(material.opacity),
            "Tr" => material.opacity = number.map(|number| 1.0 - number).or(material.opacity),
            "map_Kd" | "map_kd" if !rest.is_empty() => *diffuse_map = Some(rest.into()),
            _ => {}
        }
    }
}

/// The file that a `map_Kd` statement names after its options; may be empty.
pub(super) fn map_file(statement: &str) -> &str {
    let mut rest = statement.trim();
    loop {
        let (option, after) = split_word(rest);
        let Some(count) = option_words(option) else { break };
        rest = after;
        for at in 0..count.end {
            let (word, after) = split_word(rest);
            if at >= count.start && number_of(word).is_none() {
                break;
            }
            rest = after;
        }
    }
    let quoted = rest.strip_prefix('"').and_then(|rest| rest.strip_suffix('"'));
    quoted.unwrap_or(rest)
}

/// How many words follow an option of `map_Kd`, at least and at most; `None` if the
/// word is not an option. The words beyond the least are numbers.
fn option_words(option: &str) -> Option<Range<usize>> {
    match option {
        "-blendu" | "-blendv" | "-bm" | "-boost" | "-cc" | "-clamp" | "-colorspace"
        | "-imfchan" | "-texres" | "-type" => Some(1..1),
        "-mm" => Some(2..2),
        "-o" | "-s" | "-t" => Some(1..3),
        _ => None,
    }
}

/// A number in 32 bits; it need not be finite.
#[expect(clippy::cast_possible_truncation, reason = "a material needs no more")]
fn number_of(word: &str) -> Option<f32> {
    parse_number(word.as_bytes()).map(|number| number as f32)
}

/// The first word of a text, and the text after it.
fn split_word(text: &str) -> (&str, &str) {
    let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    (word, rest.trim_start())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_without_sense_are_ignored() {
        let text = "Kd 1 1 1\nnewmtl a\n  Kd 0.5\nKa 1 2\nKs spectral file.rfl\nNs many\nTr 0.25\n\
            map_Kd\nillum 2\nd -halo 0.5\nKe 0.0\nnewmtl\nKd 1 x\nKd 1 2 3 4\nmap_kd  a b.png \n";
        let [a, unnamed] = &parse_mtl(text)[..] else { panic!("{text}") };
        let expected = Material {
            name: "a".into(),
            diffuse: Some([0.5; 3]),
            opacity: Some(0.75),
            ..Material::default()
        };
        assert_eq!((&a.material, &a.diffuse_map), (&expected, &None));
        assert_eq!(unnamed.material.name, UNNAMED);
        assert_eq!(unnamed.material.diffuse, Some([1.0, 2.0, 3.0]));
        assert_eq!(unnamed.diffuse_map.as_deref(), Some("a b.png"));
    }

    /// The firewall removes them from the model, with a warning.
    #[test]
    fn numbers_that_are_not_finite_are_numbers() {
        let text = "newmtl a\nKd -nan(ind) 0 0\nKs 1.#INF00 1 1\nd 1.#IND\nmap_Kd -o 1.#J a.png\n";
        let [a] = &parse_mtl(text)[..] else { panic!("{text}") };
        let colors = [a.material.diffuse, a.material.specular].map(|color| color.unwrap()[0]);
        assert!(colors.iter().all(|red| !red.is_finite()) && a.material.opacity.unwrap().is_nan());
        assert_eq!(a.diffuse_map.as_deref().map(map_file), Some("a.png"));
    }

    #[test]
    fn options_of_textures_are_skipped() {
        for (statement, name) in [
            ("a.png", "a.png"),
            ("-s 1 1 1 a.png", "a.png"),
            ("-s 2 a.png", "a.png"),
            ("-o 0.1 -0.5 -t 1 -clamp on -bm 1 -mm 0 1 a b.png", "a b.png"),
            (
                "-blendu off -blendv off -cc on -texres 512 -boost 2 -imfchan m -type cube_top c.jpg",
                "c.jpg",
            ),
            ("-colorspace sRGB -o 0.1 diffuse.jpg", "diffuse.jpg"),
            ("-s 1 1 1 2 fast.png", "2 fast.png"),
            ("  \"C:\\maps\\a b.png\" ", "C:\\maps\\a b.png"),
            ("-unknown 1 a.png", "-unknown 1 a.png"),
            ("-clamp on", ""),
            ("-s 1 1 1", ""),
            ("", ""),
        ] {
            assert_eq!(map_file(statement), name, "{statement}");
        }
    }
}
