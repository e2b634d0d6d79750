//! Side files of marked edges: a pair of vertices a line, counted from 1 in the
//! order of the model's file; `#` begins a comment.

use std::path::Path;

use super::Failure;

/// Reads the pairs, counted from 0.
pub(crate) fn read_marks(path: &Path) -> Result<Vec<[u32; 2]>, Failure> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| Failure::fault(format!("{}: cannot be read: {error}", path.display())))?;
    parse_marks(&text)
        .map_err(|(line, what)| Failure::fault(format!("{}:{line}: {what}", path.display())))
}

fn parse_marks(text: &str) -> Result<Vec<[u32; 2]>, (usize, String)> {
    let mut pairs = Vec::new();
    for (line, text) in text.lines().enumerate() {
        let text = text.split('#').next().unwrap_or_default();
        let words: Vec<&str> = text.split_whitespace().collect();
        match words[..] {
            [] => {}
            [a, b] => pairs.push([vertex(line, a)?, vertex(line, b)?]),
            _ => {
                let what = format!("a mark needs two vertices, as '3 8'; this has {}", words.len());
                return Err((line + 1, what));
            }
        }
    }
    Ok(pairs)
}

fn vertex(line: usize, word: &str) -> Result<u32, (usize, String)> {
    match word.parse::<u32>() {
        Ok(vertex) if vertex > 0 => Ok(vertex - 1),
        _ => Err((line + 1, format!("'{word}' is no vertex: vertices are counted from 1"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_and_comments() {
        assert_eq!(parse_marks("# seams\n1 2\n\n 7\t3 # rim\n"), Ok(vec![[0, 1], [6, 2]]));
        for (text, line, part) in [
            ("1 2\n3", 2, "this has 1"),
            ("1 2 3", 1, "this has 3"),
            ("\n0 1", 2, "counted from 1"),
            ("1 x", 1, "'x'"),
        ] {
            let (at, what) = parse_marks(text).unwrap_err();
            assert!(at == line && what.contains(part), "{text}: {at} {what}");
        }
    }
}
