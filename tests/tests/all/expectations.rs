//! The expected results of broken and odd files, from `malformed/gen/EXPECT.tsv`.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::Output;

use serde_json::Value;
use testkit::locate::{left_out, shared};

use crate::child::{edgemesh, info, json, one_error, stderr};

/// The number of rows for stored files.
const STORED_ROWS: usize = 69;

/// The number of rows for large files, which are generated here.
const BIG_ROWS: usize = 4;

/// A row of the table.
struct Row {
    file: String,
    stored: String,
    /// `error(index)`, `warn(material)`, `ok`, `either`.
    verdict: String,
    /// The line that an error must name.
    line: Option<u32>,
    /// Counts of the file's own faces, by letter: V F T E B M I.
    counts: BTreeMap<char, u64>,
    /// Counts after welding equal positions.
    welded: BTreeMap<char, u64>,
    /// The same with a tolerance of 1e-6.
    welded_within: BTreeMap<char, u64>,
    why: String,
}

impl Row {
    fn parse(text: &str) -> Self {
        let columns: Vec<&str> = text.split('\t').collect();
        let [file, stored, expect, why] = columns[..] else { panic!("four columns in {text:?}") };
        let (verdict, rest) = expect.split_once(' ').unwrap_or((expect, ""));
        // The part about a tolerance is not for exact welding.
        let mut parts = rest.splitn(2, "welding with a tolerance:");
        let exact = parts.next().unwrap_or(rest);
        let tolerant = parts.next().unwrap_or_default();
        let (own, welded) = exact.split_once("welded:").unwrap_or((exact, ""));
        let line = own.strip_prefix("line ").and_then(|rest| rest.split(' ').next()?.parse().ok());
        Self {
            file: file.into(),
            stored: stored.into(),
            verdict: verdict.trim_end_matches(';').into(),
            line,
            counts: counts_in(own),
            welded: counts_in(welded),
            welded_within: counts_in(tolerant),
            why: why.into(),
        }
    }

    /// The word in `name(word)`.
    fn code(&self, name: &str) -> Option<&str> {
        self.verdict.strip_prefix(name)?.strip_prefix('(')?.strip_suffix(')')
    }

    /// A warning that the row allows though it expects none.
    fn allowed_warning(&self) -> Option<&str> {
        let (_, rest) = self.why.split_once("or warn(")?;
        rest.split(')').next()
    }
}

/// `V=4 F=1, ...` by letter.
fn counts_in(text: &str) -> BTreeMap<char, u64> {
    text.split([' ', ','])
        .filter_map(|word| {
            let (letter, number) = word.split_once('=')?;
            Some((letter.parse().ok()?, number.parse().ok()?))
        })
        .collect()
}

#[test]
fn rows_are_understood() {
    let row = Row::parse("obj/a.obj\tstored\tok V=24 F=6 E=24, welded: V=8 E=12\tor warn(x) it");
    assert_eq!((row.verdict.as_str(), row.line), ("ok", None));
    assert_eq!(row.counts, BTreeMap::from([('V', 24), ('F', 6), ('E', 24)]));
    assert_eq!(row.welded, BTreeMap::from([('V', 8), ('E', 12)]));
    assert_eq!(row.allowed_warning(), Some("x"));
    let row = Row::parse("obj/a.obj\tstored\terror(index) line 4\twhy");
    assert_eq!((row.code("error"), row.code("warn"), row.line), (Some("index"), None, Some(4)));
    let row = Row::parse("obj/a.obj\tstored\tok; welding with a tolerance: V=8 E=12 B=0\twhy");
    assert_eq!((row.verdict.as_str(), row.counts.len()), ("ok", 0));
    assert_eq!(row.welded_within, BTreeMap::from([('V', 8), ('E', 12), ('B', 0)]));
}

/// The folder of the table and its rows about files.
fn rows(shared: &Path) -> (PathBuf, Vec<Row>) {
    let folder = shared.join("corpus/malformed/gen");
    let table = fs::read_to_string(folder.join("EXPECT.tsv")).unwrap();
    let rows = table.lines().skip(1).map(Row::parse);
    (folder, rows.filter(|row| row.stored != "special").collect())
}

#[test]
fn stored_rows_give_what_the_table_says() {
    let Some(shared) = shared() else { return left_out("broken files", STORED_ROWS) };
    let (folder, rows) = rows(&shared);
    let stored: Vec<&Row> = rows.iter().filter(|row| row.stored == "stored").collect();
    assert!(stored.len() >= STORED_ROWS, "{} rows in the table", stored.len());
    let wrong: Vec<String> = stored
        .iter()
        .filter_map(|row| {
            let why = check_row(row, &folder.join(&row.file)).err()?;
            Some(format!("{} ({} {}): {why}", row.file, row.verdict, row.why))
        })
        .collect();
    assert!(wrong.is_empty(), "{} rows are wrong:\n{}", wrong.len(), wrong.join("\n"));
}

fn check_row(row: &Row, path: &Path) -> Result<(), String> {
    let output = info(path);
    let again = info(path);
    if output != again {
        return Err(format!("two runs differ: {output:?} and {again:?}"));
    }
    let status = output.status.code();
    if let Some(code) = row.code("error") {
        return check_error(row, path, &output, code);
    }
    match (row.verdict.as_str(), status) {
        ("either", _) => check_any(&output),
        (_, Some(0)) => {
            let info = json(&output);
            check_counts(row, &info)?;
            check_welded_within(row, path)?;
            check_warnings(row, &info, &stderr(&output))
        }
        _ => Err(format!("{:?}: {}", output.status, stderr(&output))),
    }
}

fn check_error(row: &Row, path: &Path, output: &Output, code: &str) -> Result<(), String> {
    if output.status.code() != Some(1) {
        return Err(format!("{:?} instead of exit status 1", output.status));
    }
    let place = match row.line {
        Some(line) => format!("{}:{line}: ", path.display()),
        None => path.display().to_string(),
    };
    one_error(output, &[&place])?;
    // The message does not contain the code; the error of the library does.
    match edgemesh::format::read::read_model(path) {
        Err(error) if error.kind.as_str() == code => Ok(()),
        Err(error) => {
            Err(format!("error({}) instead of error({code}): {error}", error.kind.as_str()))
        }
        Ok(_) => Err("the library reads it".into()),
    }
}

fn check_counts(row: &Row, info: &Value) -> Result<(), String> {
    let source = &info["source"];
    let own = |letter| match letter {
        'V' => &source["vertices"],
        'F' => &source["polygons"],
        'T' => &source["triangles"],
        'E' => &source["edges"],
        'B' => &source["boundary_edges"],
        'M' => &source["non_manifold_edges"],
        'I' => &source["inconsistent_edges"],
        _ => &Value::Null,
    };
    for (&letter, &count) in &row.counts {
        if own(letter).as_u64() != Some(count) {
            return Err(format!("{letter}={count} is {} in {source}", own(letter)));
        }
    }
    check_welded(&row.welded, info)
}

/// Checks the counts after welding with a tolerance, if the row has them.
fn check_welded_within(row: &Row, path: &Path) -> Result<(), String> {
    if row.welded_within.is_empty() {
        return Ok(());
    }
    let path = path.to_str().ok_or("no UTF-8")?;
    let output = edgemesh(&["info", "--json", "--weld", "1e-6", path]);
    check_welded(&row.welded_within, &json(&output))
}

fn check_welded(welded: &BTreeMap<char, u64>, info: &Value) -> Result<(), String> {
    for (&letter, &count) in welded {
        let number = |key: &str| info[key].as_u64();
        let found = match letter {
            'V' => number("welded_vertices"),
            'E' => number("edges").zip(number("diagonal_edges")).map(|(all, cut)| all - cut),
            'B' => number("boundary_edges"),
            _ => None,
        };
        if found != Some(count) {
            return Err(format!("welded {letter}={count} is {found:?}"));
        }
    }
    Ok(())
}

fn check_warnings(row: &Row, info: &Value, stderr: &str) -> Result<(), String> {
    let warnings = info["warnings"].as_array().ok_or("no warnings in the JSON")?;
    let codes: Vec<&str> = warnings.iter().filter_map(|warning| warning["code"].as_str()).collect();
    if stderr.lines().count() != warnings.len() {
        return Err(format!("{codes:?} and on standard error {stderr:?}"));
    }
    match row.code("warn") {
        Some(code) if codes.contains(&code) => Ok(()),
        None if codes.iter().all(|code| row.allowed_warning() == Some(*code)) => Ok(()),
        _ => Err(format!("warnings {codes:?}")),
    }
}

/// Asserts that a file loads, or is refused with one message.
pub(crate) fn check_any(output: &Output) -> Result<(), String> {
    match output.status.code() {
        Some(0) => Ok(()),
        Some(1) => one_error(output, &[]),
        _ => Err(format!("{:?}: {}", output.status, stderr(output))),
    }
}

/// Writes the large file with this name.
pub(crate) fn write_big(name: &str, path: &Path) {
    let mut out = BufWriter::new(File::create(path).unwrap());
    match name {
        "obj/big_isolated_vertices.obj" => {
            out.write_all(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
            for vertex in 0..1_000_000 {
                writeln!(out, "v {vertex}.5 {}.25 0.125", vertex / 7).unwrap();
            }
        }
        "obj/big_groups.obj" => {
            for group in 0..100_000 {
                writeln!(out, "o part{group}\nv {group} 0 0\nv {group} 1 0\nv {group} 0 1")
                    .unwrap();
                writeln!(out, "f -3 -2 -1").unwrap();
            }
        }
        "obj/big_line_16MiB.obj" => {
            out.write_all(b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n# ").unwrap();
            out.write_all(&vec![b'x'; 16 << 20]).unwrap();
            out.write_all(b"\nf 1 2 3\nf 1 3 4\n").unwrap();
        }
        "obj/big_hub_vertex.obj" => write_cone(&mut out, 100_000),
        _ => panic!("no generator for {name}"),
    }
    out.flush().unwrap();
}

/// A cone: the tip and a rim of `count` vertices.
pub(crate) fn write_cone(out: &mut impl Write, count: u32) {
    writeln!(out, "v 0 0 1").unwrap();
    for step in 0..count {
        let angle = f64::from(step) * std::f64::consts::TAU / f64::from(count);
        writeln!(out, "v {:.7} {:.7} 0", angle.cos(), angle.sin()).unwrap();
    }
    for step in 0..count {
        writeln!(out, "f 1 {} {}", step + 2, (step + 1) % count + 2).unwrap();
    }
}

#[test]
fn big_rows_give_what_the_table_says() {
    let Some(shared) = shared() else { return left_out("large files", BIG_ROWS) };
    let (_, rows) = rows(&shared);
    let big: Vec<&Row> = rows.iter().filter(|row| row.stored == "big").collect();
    assert_eq!(big.len(), BIG_ROWS, "large files of the table");
    let folder = tempfile::tempdir().unwrap();
    for row in big {
        let path = folder.path().join("big.obj");
        write_big(&row.file, &path);
        let output = info(&path);
        assert_eq!(output.status.code(), Some(0), "{}: {}", row.file, stderr(&output));
        let info = json(&output);
        assert_eq!(check_counts(row, &info), Ok(()), "{}", row.file);
        assert_eq!(check_warnings(row, &info, &stderr(&output)), Ok(()), "{}", row.file);
    }
}
