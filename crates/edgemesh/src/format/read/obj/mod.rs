//! Wavefront OBJ, in parallel.
//!
//! Source: Alias|Wavefront, *Advanced Visualizer Manual*, appendix B1, and what
//! programs write.
//!
//! Idea: the text is cut at line ends into blocks. Each is parsed as if it were a
//! file ([`block`]), all in parallel, and then they are merged in their order
//! ([`merge`]): relative indices and line numbers become absolute, and the state at
//! the end of a block (material, group, smoothing) begins the next one. The result
//! does not depend on where the text was cut.
//!
//! ```text
//! bytes --split--> texts --parse--> blocks --merge--> Model <-- materials, mtl
//! ```
//!
//! Rejected: `tobj` and `obj-rs`, which report no lines, lose polygons, smoothing
//! groups or `l` statements, and refuse files that other programs write. Tests
//! compare this reader with both.

mod block;
mod materials;
mod merge;
mod mtl;
mod stated;
mod statement;

use std::borrow::Cow;

use memchr::memchr;
use rayon::prelude::*;

use self::block::{ParsedBlock, parse_block};
use self::merge::merge;
use self::stated::{line_classes, state_classes, states_classes};
use super::byte_order_mark::without_mark;
use super::error::{ReadError, ReadErrorKind};
use super::source::Source;
use crate::model::Model;
use crate::report::Report;

/// Bytes of a block: large enough to hide its overhead, small enough that a file of
/// some megabytes keeps every core busy.
const BLOCK_BYTES: usize = 1 << 20;

/// Reads an OBJ file in UTF-8, UTF-16 or an old code page.
///
/// # Errors
/// Number: a coordinate is not a number. Index: a face or line names a vertex that
/// does not exist. Size: too many elements. Format: broken UTF-16.
pub(super) fn read_obj(source: &Source, report: &mut Report) -> Result<Model, ReadError> {
    let text = utf8_of(source)?;
    read_in_blocks(source, &text, BLOCK_BYTES, report)
}

fn read_in_blocks(
    source: &Source,
    text: &[u8],
    block_bytes: usize,
    report: &mut Report,
) -> Result<Model, ReadError> {
    let blocks: Vec<ParsedBlock> =
        split(text, block_bytes).into_par_iter().map(parse_block).collect();
    let classes = states_classes(text).then(|| line_classes(&blocks));
    let mut model = merge(source, blocks, report)?;
    if let Some(classes) = classes {
        state_classes(&mut model, &classes);
    }
    Ok(model)
}

/// The text without its byte order mark, UTF-16 converted to UTF-8.
fn utf8_of<'a>(source: &Source<'a>) -> Result<Cow<'a, [u8]>, ReadError> {
    let bytes = source.bytes;
    let (rest, is_big_endian) = match bytes {
        [0xff, 0xfe, rest @ ..] => (rest, false),
        [0xfe, 0xff, rest @ ..] => (rest, true),
        _ => return Ok(Cow::Borrowed(without_mark(bytes))),
    };
    let units = rest.as_chunks::<2>().0.iter().map(|&unit| match is_big_endian {
        true => u16::from_be_bytes(unit),
        false => u16::from_le_bytes(unit),
    });
    let text: Result<String, _> = char::decode_utf16(units).collect();
    text.map(|text| Cow::Owned(text.into_bytes())).map_err(|_| {
        let what = "broken UTF-16 text: save it as UTF-8";
        source.error(ReadErrorKind::Format, None, what)
    })
}

/// Cuts the text after line ends, but not where a statement continues.
fn split(text: &[u8], block_bytes: usize) -> Vec<&[u8]> {
    let mut blocks = Vec::new();
    let mut start = 0;
    while start < text.len() {
        let end = block_end(text, (start + block_bytes).min(text.len()));
        blocks.push(&text[start..end]);
        start = end;
    }
    blocks
}

/// The first end of a statement at or after `from`.
fn block_end(text: &[u8], from: usize) -> usize {
    let mut at = from;
    // From one byte before, to find a line end there.
    while let Some(found) = memchr(b'\n', &text[at - 1..]) {
        let line_end = at - 1 + found;
        if !text[..line_end].trim_ascii_end().ends_with(b"\\") {
            return line_end + 1;
        }
        at = line_end + 2;
        if at > text.len() {
            break;
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::format::read::{Format, picture, read_model, read_model_bytes};
    use crate::index::NONE;
    use crate::model::{Material, Segment, Smoothing, Texture, TextureSource};
    use crate::report::{Place, WarningCode};

    fn try_read(text: &[u8], block_bytes: usize) -> (Result<Model, ReadError>, Report) {
        let mut report = Report::default();
        let source = Source { name: "test.obj", folder: None, bytes: text };
        let text = utf8_of(&source).unwrap();
        let model = read_in_blocks(&source, &text, block_bytes, &mut report);
        (model, report)
    }

    fn read(text: &str) -> Model {
        try_read(text.as_bytes(), BLOCK_BYTES).0.unwrap()
    }

    const THREE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

    #[test]
    fn polygons_objects_and_mixed_corners() {
        let model = read(
            "o first\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n\
             f 1/1/1 2 3//1 4\no second\nv 0 0 1\nf 1 2 -1 # 9 9\n",
        );
        assert_eq!(model.positions.len(), 5);
        assert_eq!(model.polygon_ends, [4, 7]);
        assert_eq!(model.corner_positions, [0, 1, 2, 3, 0, 1, 4]);
        assert_eq!(model.corner_texcoords[..4], [0, NONE, NONE, NONE]);
        assert_eq!(model.corner_normals[..4], [0, NONE, 0, NONE]);
        assert_eq!(model.groups, ["first", "second"]);
        assert_eq!(model.per_polygon(|run| run.group), [0, 1]);
    }

    #[test]
    fn lines_end_and_continue_in_every_way() {
        let text = "v 0 0 0\r\nv 1 0 0\rv 0 1 0\nf 1 \\\r\n2 \\\n 3\nf 3 2 1 \\";
        let model = read(text);
        assert_eq!(model.corner_positions, [0, 1, 2, 2, 1, 0]);
        assert_eq!(model.polygon_lines, [4, 7]);
    }

    /// The only warning, with its count and line.
    fn syntax_warning(report: &Report) -> (usize, Option<Place>) {
        let [warning] = report.warnings() else { panic!("{report:?}") };
        assert_eq!(warning.code, WarningCode::Syntax, "{report:?}");
        (warning.count, warning.place.clone())
    }

    #[test]
    fn a_statement_that_a_backslash_joins_to_another_line_gives_a_warning() {
        for before in ["# from D:\\parts\\", "g D:\\parts\\", "usemtl a\\", "o \\", "v 0 0 1\\"] {
            let text = format!("{THREE}{before}\nf 1 2 3\nf 3 2 1\n");
            let (model, report) = try_read(text.as_bytes(), 8);
            assert_eq!(model.unwrap().polygon_count(), 1, "{before}");
            assert_eq!(syntax_warning(&report), (1, Some(Place::Line(5))), "{before}");
            let message = &report.warnings()[0].message;
            assert!(message.contains("'f 1 2 3'") && message.contains("remove the"), "{message}");
        }
        let text = format!("{THREE}# \\\nf 1 2 3\\\nl 1 2\nf 1 2 3\n");
        let (_, report) = try_read(text.as_bytes(), BLOCK_BYTES);
        assert_eq!(syntax_warning(&report), (2, Some(Place::Line(5))));
        let text = format!("{THREE}# a\\\nb\nmtllib a.mtl\\\nb.mtl\ng a\\\n b\nf 1\\\n2\\\n3\n");
        let (model, report) = try_read(text.as_bytes(), BLOCK_BYTES);
        assert_eq!((model.unwrap().polygon_count(), report.count(WarningCode::Syntax)), (1, 0));
    }

    #[test]
    fn keywords_in_capitals_are_read_with_a_warning() {
        let text = "V 0 0 0\nV 1 0 0\nv 0 1 0\nVT 0 0\nUSEMTL red\nF 1/1 2/1 3/1\nFACE 1\n";
        let (model, report) = try_read(text.as_bytes(), 8);
        let model = model.unwrap();
        assert_eq!((model.positions.len(), &model.corner_texcoords[..]), (3, &[0, 0, 0][..]));
        assert_eq!(model.materials[0].name, "red");
        assert_eq!(syntax_warning(&report), (5, Some(Place::Line(1))));
    }

    #[test]
    fn numbers_that_are_not_finite_may_be_spelled_as_c_libraries_do() {
        for number in ["nan", "-nan(ind)", "1.#INF00", "-1.#IND", "1.#QNAN", "1.#SNAN", "1.#J"] {
            let text = format!(
                "{THREE}v {number} 0 {number}\nv 0 0 {number} # corner\nvn {number} 0 0\n\
                 vt 0 {number}\nf 1 2 3\nf 1 2 4\n"
            );
            let (model, report) = read_model_bytes("a", text.as_bytes(), Format::Obj).unwrap();
            assert_eq!((model.polygon_count(), model.positions.len()), (1, 5), "{number}");
            let [warning] = report.warnings() else { panic!("{number}: {report:?}") };
            let found = (warning.code, warning.count, warning.place.clone());
            assert_eq!(found, (WarningCode::NonFinite, 4, Some(Place::Line(4))), "{number}");
        }
        let (model, _) = try_read(b"v 1 2 3.#note\n", BLOCK_BYTES);
        assert_eq!(model.unwrap().positions, [[1.0, 2.0, 3.0]]);
    }

    #[test]
    fn wrong_indices_name_their_line() {
        for (face, word) in [
            ("f 1 2 4", "past 3"),
            ("f 1 2 -4", "before the first"),
            ("f 1 2 0", "count from 1"),
            ("f 1 2 3.5", "whole number"),
            ("f 1 2 4294967299", "past 3"),
            ("f 1 2 99999999999999999999", "too large"),
            ("f 1 2 -2147483648", "before the first"),
            ("f 1/2/3/4 2 3", "slashes"),
            ("l 1 4", "past 3"),
        ] {
            let error = try_read(format!("{THREE}{face}\n").as_bytes(), 8).0.unwrap_err();
            assert_eq!(error.kind, ReadErrorKind::Index, "{face}");
            assert_eq!(error.place, Some(Place::Line(4)), "{face}: {error}");
            assert!(error.what.contains(word), "{face}: {error}");
        }
    }

    /// The vertex that the face names comes after a line that cannot be read.
    #[test]
    fn an_unreadable_line_is_reported_before_wrong_indices() {
        let text = b"v 0 0 0\nv 1 0 0\nf 1 2 3\nv 0 x 0\nv 0 1 0\n";
        for block_bytes in [1, 16, BLOCK_BYTES] {
            let error = try_read(text, block_bytes).0.unwrap_err();
            assert_eq!((error.kind, error.place), (ReadErrorKind::Number, Some(Place::Line(4))));
        }
    }

    #[test]
    fn wrong_attributes_are_left_out_and_the_face_is_kept() {
        let text = format!("{THREE}vt 0 0\nf 1/1 2/7 3/-3\nf 1/x 2 3\n");
        let (model, report) = try_read(text.as_bytes(), BLOCK_BYTES);
        assert_eq!(model.unwrap().corner_texcoords, [0, NONE, NONE, NONE, NONE, NONE]);
        assert_eq!(report.count(WarningCode::Index), 3);
    }

    #[test]
    fn smoothing_and_materials_follow_the_faces() {
        let model = read(&format!("{THREE}usemtl a b\ns 2\nf 1 2 3\ns off\nusemtl c\nf 3 2 1\n"));
        let names: Vec<&str> = model.materials.iter().map(|m| m.name.as_str()).collect();
        assert_eq!(names, ["a b", "c"]);
        assert_eq!(
            model.per_polygon(|run| (run.material, run.smoothing)),
            [(0, Smoothing::Group(2)), (1, Smoothing::Group(0))]
        );
        let model = read(&format!("{THREE}f 1 2 3\n"));
        assert!(model.runs.is_empty());
        let model = read(&format!("{THREE}f 1 2 3\ns 1\nf 3 2 1\n"));
        let smoothing = model.per_polygon(|run| run.smoothing);
        assert_eq!(smoothing, [Smoothing::Group(0), Smoothing::Group(1)], "off before the first");
    }

    /// From files to the fill of the edge mesh.
    #[test]
    fn materials_groups_and_textures_reach_the_fill() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
        write("bark.png", picture::SAMPLES[0]);
        write(
            "tree.mtl",
            b"newmtl bark\nKa 0.1 0.1 0.1\nKd 0.8 0.5 0.2\nNs 12\n\
              map_Kd -s 2 2 1 -clamp on bark.png\nnewmtl leaf\nKd 0 1 0\nTr 0.5\n",
        );
        write(
            "tree.obj",
            b"mtllib tree.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\n\
              vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\ng trunk\nusemtl bark\nf 1/1 2/2 3/3 4/4\n\
              g crown\nf 2/1 1/2 5/3\nusemtl leaf\nf 2 5 6\nusemtl leaf\nf 2 6 3\n",
        );
        let (model, mut report) = read_model(&folder.path().join("tree.obj")).unwrap();
        let fill = build_edge_mesh(&model, &BuildOptions::default(), &mut report).fill;
        assert!(report.warnings().is_empty(), "{report:?}");
        let runs: Vec<[u32; 4]> = fill.runs.into_iter().map(bytemuck::cast).collect();
        assert_eq!(runs, [[0, 0, 0, 1], [2, 0, 1, 1], [3, 1, 1, 0]]);
        assert_eq!(fill.groups, ["trunk", "crown"]);
        let texture = Texture {
            name: "bark.png".into(),
            source: TextureSource::File(folder.path().canonicalize().unwrap().join("bark.png")),
        };
        let bark = Material {
            name: "bark".into(),
            ambient: Some([0.1; 3]),
            diffuse: Some([0.8, 0.5, 0.2]),
            shininess: Some(12.0),
            diffuse_texture: Some(texture),
            ..Material::default()
        };
        let leaf = Material {
            name: "leaf".into(),
            diffuse: Some([0.0, 1.0, 0.0]),
            opacity: Some(0.5),
            ..Material::default()
        };
        assert_eq!(fill.materials, [bark, leaf]);
    }

    #[test]
    fn line_statements_are_segments() {
        let model = read(&format!("{THREE}l 1 2/1 -1\nl 1\n"));
        let ends: Vec<_> = model.segments.iter().map(|segment| segment.ends).collect();
        assert_eq!(ends, [[0, 1], [1, 2]]);
        assert_eq!(model.segments[0], Segment { ends: [0, 1], line: 4 });
    }

    #[test]
    fn colors_may_be_partial() {
        let model = read("v 0 0 0\nv 1 0 0 1\nv 0 1 0 0.5 0 1\nv 0 1 1 1 0 0 1\nf 1 2 3\n");
        assert_eq!(model.colors, [[1.; 4], [1.; 4], [0.5, 0., 1., 1.], [1., 0., 0., 1.]]);
        assert!(read(&format!("{THREE}f 1 2 3\n")).colors.is_empty());
    }

    #[test]
    fn not_a_number_and_not_finite_differ() {
        let error = try_read(b"v 0 zero 0\n", BLOCK_BYTES).0.unwrap_err();
        assert_eq!((error.kind, error.place), (ReadErrorKind::Number, Some(Place::Line(1))));
        let error = try_read(b"v 0 1\n", BLOCK_BYTES).0.unwrap_err();
        assert!(error.what.contains("has 2"), "{error}");
        let (_, report) = try_read(format!("{THREE}v 1e400 0 0\nf 1 2 3\n").as_bytes(), 8);
        assert_eq!(report.warnings()[0].place, Some(Place::Line(4)));
        let (model, report) = try_read(b"v 3.1+e2 0 0\n", BLOCK_BYTES);
        assert_eq!(model.unwrap().positions[0][0].to_bits(), 3.1_f64.to_bits());
        assert_eq!(report.count(WarningCode::Syntax), 1);
    }

    #[test]
    fn utf16_is_read() {
        let text = format!("{THREE}f 1 2 3\n");
        for big_endian in [false, true] {
            let bytes: Vec<u8> = format!("\u{feff}{text}")
                .encode_utf16()
                .flat_map(|unit| if big_endian { unit.to_be_bytes() } else { unit.to_le_bytes() })
                .collect();
            assert_eq!(try_read(&bytes, 8).0.unwrap().polygon_count(), 1);
        }
    }

    /// Every kind of statement, in an order that makes blocks depend on each other.
    #[test]
    fn the_result_does_not_depend_on_the_blocks() {
        let mut text = String::from("mtllib none.mtl\n# comment \\\nstill comment\n");
        for k in 0..60 {
            text += &format!("v {k} {} 0.25{}\n", k % 7, ["", " 1 0 0", " 1"][k % 3]);
            text += &format!("vt 0.{k} 1\nvn 0 0 {k}\n");
            text += match k % 6 {
                0 if k > 2 => "usemtl steel\nf -1 -2 -3\n",
                1 if k > 2 => "g part\nf -1/-1 -2/-2 \\\n -3/-3\n",
                2 => "s 4\nl -1 -2\n",
                3 => "f 1//1 2//2 3//3 4//4\n",
                4 => "usemtl tin\r\no thing\r\n",
                _ => "s off\nbevel on\ncstype bezier\nf 1/1/1 2/2/2 -1/-1/-1\n",
            };
        }
        let (whole, whole_report) = try_read(text.as_bytes(), usize::MAX >> 1);
        let whole = whole.unwrap();
        assert!(whole.polygon_count() > 30 && whole.runs.len() > 10);
        for block_bytes in [1, 7, 50, 333] {
            let (model, report) = try_read(text.as_bytes(), block_bytes);
            assert_eq!(format!("{:?}", model.unwrap()), format!("{whole:?}"), "{block_bytes}");
            assert_eq!(report, whole_report, "{block_bytes}");
        }
    }
}
