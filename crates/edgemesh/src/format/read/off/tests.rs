//! Small files in both encodings.

use super::*;
use crate::format::read::error::ReadErrorKind;
use crate::index::NONE;
use crate::report::{Place, WarningCode};

fn read_bytes(bytes: &[u8], report: &mut Report) -> Result<Model, ReadError> {
    read_off(&Source { name: "test", folder: None, bytes }, report)
}

fn read(text: &str, report: &mut Report) -> Result<Model, ReadError> {
    read_bytes(text.as_bytes(), report)
}

/// The model of a text without a warning.
fn sound(text: &str) -> Model {
    let mut report = Report::default();
    let model = read(text, &mut report).unwrap();
    assert!(report.warnings().is_empty(), "{report:?}");
    model
}

/// Four vertices and two faces, without a header.
const BODY: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n3 2 1 0\n";

fn check_square(model: &Model, lines: [u32; 2]) {
    assert_eq!(model.positions, [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]]);
    assert_eq!(model.corner_positions, [0, 1, 2, 3, 2, 1, 0]);
    assert_eq!(model.polygon_ends, [4, 7]);
    assert_eq!(model.polygon_lines, lines);
    assert!(model.colors.is_empty() && model.corner_normals.is_empty());
}

#[test]
fn headers_come_in_many_forms() {
    for (header, lines) in [
        ("OFF\n4 2 0\n", [7, 8]),
        ("OFF 4 2 0\n", [6, 7]),
        ("OFF4 2 0\n", [6, 7]),
        ("OFF\n4 2\n", [7, 8]),
        ("4 2 0\n", [6, 7]),
        ("\u{feff}# a comment\n\nOFF # and one more\n# again\n4 2 0 # counts\n\n", [11, 12]),
    ] {
        check_square(&sound(&format!("{header}{BODY}")), lines);
        let returns = format!("{header}{BODY}").replace('\n', "\r\n");
        check_square(&sound(&returns), lines);
        check_square(&sound(returns.trim_end()), lines);
    }
}

#[test]
fn colors_are_bytes_or_fractions() {
    for (color, alpha) in [
        ("255 0 51", 1.0),
        ("255 0 51 9", 9.0 / 255.0),
        ("1.0 0 0.2", 1.0),
        ("1 0 .2 0.5", 0.5),
        ("255.0 0.0 51.0 255.0", 1.0),
    ] {
        let red = [1.0, 0.0, 0.2, alpha];
        let text = format!("COFF 3 1 0\n0 0 0 {color}\n1 0 0 {color}\n0 1 0 {color}\n3 0 1 2");
        assert_eq!(sound(&text).colors, [red; 3], "{color}");
    }
    let text = "COFF 3 1 0\n0 0 0 1 1 1\n1 0 0 0 1 0\n0 1 0 255 0 0\n3 0 1 2\n";
    let dark = 1.0 / 255.0;
    let [nearly_black, red] = [[dark, dark, dark, 1.0], [1.0, 0.0, 0.0, 1.0]];
    assert_eq!(sound(text).colors, [nearly_black, [0.0, dark, 0.0, 1.0], red]);
    let text = "COFF 3 1 0\n0 0 0 1 1 1\n1 0 0 0 1 0\n0 1 0 0 0 0\n3 0 1 2\n";
    assert_eq!(sound(text).colors[0], [1.0; 4], "white, as no channel is above 1");
}

#[test]
fn values_follow_the_order_of_geomview() {
    let vertex = "0 0 1  1 0.5 0 1  0.25 0.75";
    let text = format!("STCNOFF\n3 1 0\n0 0 0 {vertex}\n1 0 0 {vertex}\n0 1 0 {vertex}\n3 0 1 2\n");
    let model = sound(&text);
    assert_eq!(model.normals, [[0.0, 0.0, 1.0]; 3]);
    assert_eq!(model.colors, [[1.0, 0.5, 0.0, 1.0]; 3]);
    assert_eq!(model.texcoords, [[0.25, 0.75]; 3]);
    assert_eq!(
        (&model.corner_normals[..], &model.corner_texcoords[..]),
        (&[0, 1, 2][..], &[0, 1, 2][..])
    );
    let text = "NOFF\n3 1 0\n0 0 0 0 0 2\n1 0 0 0 0 2\n0 1 0 0 0 2\n3 2 1 0\n";
    let model = sound(text);
    assert_eq!((model.normals[0], &model.corner_normals[..]), ([0.0, 0.0, 2.0], &[2, 1, 0][..]));
    assert_eq!(model.corner(0).texcoord, NONE);
}

#[test]
fn colors_of_faces_are_those_of_their_corners() {
    for (color, found) in [
        ("", None),
        ("7", None),
        ("255 0 51", Some([1.0, 0.0, 0.2, 1.0])),
        ("0.1 0.2 0.3 0.4", Some([0.1, 0.2, 0.3, 0.4])),
        ("1 0 0 # red", Some([1.0, 0.0, 0.0, 1.0])),
    ] {
        let model = sound(&format!("OFF 3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 {color}\n3 2 1 0\n"));
        assert_eq!(model.corner_positions, [0, 1, 2, 2, 1, 0]);
        assert_eq!(model.colors.first().copied(), found);
        assert_eq!(model.corner_color(0), found.unwrap_or([1.0; 4]));
        assert_eq!(model.corner_color(5), [1.0; 4], "a face without a color is white");
    }
    let vertex = "0 0 0 0.5 0.5 0.5\n";
    let model = sound(&format!("COFF 3 1 0\n{vertex}{vertex}{vertex}3 0 1 2 255 0 0\n"));
    assert_eq!((model.corner_color(0), model.colors.len()), ([0.5, 0.5, 0.5, 1.0], 3));
    for color in ["1 2", "1 2 3 4 5", "red"] {
        let text = format!("OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 {color}\n");
        let mut report = Report::default();
        assert_eq!(read(&text, &mut report).unwrap().polygon_count(), 1);
        let [warning] = report.warnings() else { panic!("{report:?}") };
        assert_eq!((warning.code, &warning.place), (WarningCode::Syntax, &Some(Place::Line(5))));
    }
}

#[test]
fn surplus_content_is_left_out_with_a_warning() {
    use WarningCode::{Degenerate, Syntax};
    for (text, code, count, line) in [
        (format!("OFF 4 2 0\n{BODY}\n# end\n3 0 1 2\n"), Syntax, 1, 10),
        (format!("OFF 4 2 0\n{}", BODY.replace("1 1 0\n", "1 1 0 255 0 0\n")), Syntax, 1, 4),
        (format!("OFF 4 2 0\n{}", BODY.replace("3 2 1 0", "2 1 0")), Degenerate, 1, 7),
        (format!("OFF 4 2 0\n{}", BODY.replace("3 2 1 0", "0")), Degenerate, 1, 7),
    ] {
        let mut report = Report::default();
        read(&text, &mut report).unwrap();
        let [warning] = report.warnings() else { panic!("{report:?}") };
        assert_eq!((warning.code, warning.count), (code, count), "{text}");
        assert_eq!(warning.place, Some(Place::Line(line)), "{text}");
    }
}

#[test]
fn errors_of_text_have_their_line() {
    use ReadErrorKind::{Format, Index, Number, Syntax, Truncated};
    let square = |from: &str, to: &str| format!("OFF\n4 2 0\n{}", BODY.replace(from, to));
    for (text, kind, line, what) in [
        ("4OFF\n1 0 0\n".into(), Format, 1, "'4OFF' has vertices of other than three dimensions"),
        ("\nnOFF\n5\n1 0 0\n".into(), Format, 2, "'nOFF' has vertices"),
        ("solid\n".into(), Format, 1, "neither with the word 'OFF' nor with counts"),
        ("OFF\n".into(), Truncated, 2, "ends before its counts"),
        ("OFF\n4\n".into(), Syntax, 2, "needs the counts of vertices and faces"),
        ("OFF\n-4 2 0\n".into(), Syntax, 2, "'-4' is not one"),
        ("OFF\n4.5 2 0\n".into(), Syntax, 2, "'4.5' is not one"),
        ("OFF\n18446744073709551615 9 0\n0".into(), Truncated, 2, "1 are left"),
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n".into(), Truncated, 6, "before face 1 of 1"),
        (square("3 2 1 0\n", ""), Truncated, 8, "before face 2 of 2"),
        (square("1 1 0", "1 1"), Syntax, 5, "needs 3 values here, this one has 2"),
        (square("1 1 0", "1 1 O"), Number, 5, "'O' is not a number"),
        (square("1 1 0", "1 1,0 0"), Number, 5, "'1,0' is not a number"),
        (square("4 0 1 2 3", "4 0 1 2"), Syntax, 7, "a face of 4 corners has 3 vertices"),
        (square("4 0 1 2 3", "-1"), Syntax, 7, "a face has -1 corners"),
        (square("4 0 1 2 3", "nan 0"), Syntax, 7, "a face has NaN corners"),
        (square("4 0 1 2 3", "1e300 0"), Syntax, 7, "corners; faces have"),
        (square("4 0 1 2 3", "3 0 1 4"), Index, 7, "index 4 is not one of 4 vertices"),
        (square("4 0 1 2 3", "3 0 1 -1"), Index, 7, "index -1 is not"),
        (square("4 0 1 2 3", "3 0 1 nan"), Index, 7, "index NaN is not"),
    ] {
        let error = read(&text, &mut Report::default()).unwrap_err();
        assert_eq!((error.kind, &error.place), (kind, &Some(Place::Line(line))), "{text}");
        assert!(error.what.contains(what), "{error}");
    }
}

/// A binary file: a keyword, and values that are integers or floats.
fn binary(keyword: &str, rows: &[&[Value]]) -> Vec<u8> {
    let mut bytes = format!("{keyword} BINARY\n").into_bytes();
    for value in rows.concat() {
        bytes.extend(match value {
            Value::Integer(value) => value.to_be_bytes(),
            Value::Float(value) => value.to_be_bytes(),
        });
    }
    bytes
}

#[derive(Clone, Copy)]
enum Value {
    Integer(i32),
    Float(f32),
}

fn integers<const N: usize>(values: [i32; N]) -> [Value; N] {
    values.map(Value::Integer)
}

fn floats<const N: usize>(values: [f32; N]) -> [Value; N] {
    values.map(Value::Float)
}

#[test]
fn binary_files_are_big_endian() {
    let positions = floats([0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.]);
    let rows: [&[Value]; 5] = [
        &integers([4, 2, 0]),
        &positions,
        &integers([4, 0, 1, 2, 3, 3]),
        &floats([0.5, 0.5, 0.5]),
        &integers([3, 2, 1, 0, 0]),
    ];
    let mut report = Report::default();
    let model = read_bytes(&binary("OFF", &rows), &mut report).unwrap();
    assert_eq!(model.positions, [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]]);
    assert_eq!(
        (&model.corner_positions[..4], &model.polygon_ends[..]),
        (&[0, 1, 2, 3][..], &[4, 7][..])
    );
    assert!(model.polygon_lines.is_empty() && report.warnings().is_empty(), "{report:?}");
    assert_eq!([model.corner_color(3), model.corner_color(4)], [[0.5, 0.5, 0.5, 1.0], [1.0; 4]]);
    let vertex = floats([1., 2., 3., 0., 0., 1., 1., 0.5, 0., 1., 0.25, 0.75]);
    let rows: [&[Value]; 5] =
        [&integers([3, 1, 0]), &vertex, &vertex, &vertex, &integers([3, 0, 1, 2, 0, 7])];
    let model = read_bytes(&binary("STCNOFF", &rows), &mut report).unwrap();
    assert_eq!((model.positions[2], model.normals[2]), ([1., 2., 3.], [0., 0., 1.]));
    assert_eq!((model.colors[2], model.texcoords[2]), ([1., 0.5, 0., 1.], [0.25, 0.75]));
    assert_eq!(report.count(WarningCode::Syntax), 1, "a value after the last face");
}

#[test]
fn errors_of_bytes_have_their_offset() {
    use ReadErrorKind::{Index, Syntax, Truncated};
    let vertices = floats([0.0; 9]);
    let face = |values: &[i32]| {
        let face: Vec<Value> = values.iter().map(|&value| Value::Integer(value)).collect();
        binary("OFF", &[&integers([3, 1, 0]), &vertices, &face])
    };
    let start = "OFF BINARY\n".len() as u64;
    for (bytes, kind, at, what) in [
        (binary("OFF", &[&integers([3, 1])]), Truncated, 0, "ends within this row"),
        (binary("OFF", &[&integers([-3, 1, 0])]), Syntax, 0, "states -3 vertices"),
        (binary("OFF", &[&integers([i32::MAX, i32::MAX, 0])]), Truncated, 0, "but 0 are left"),
        (face(&[-1, 0]), Syntax, 48, "a face has -1 corners"),
        (face(&[i32::MAX, 0]), Truncated, 48, "ends within this row"),
        (face(&[3, 0, 1, 2]), Truncated, 48, "ends within this row"),
        (face(&[3, 0, 1, 2, 5]), Syntax, 48, "has 5 values"),
        (face(&[3, 0, 1, 2, 1]), Truncated, 48, "ends within this row"),
        (face(&[3, 0, 1, 3, 0]), Index, 48, "index 3 is not one of 3"),
        (face(&[3, 0, 1, -1, 0]), Index, 48, "index -1 is not"),
    ] {
        let error = read_bytes(&bytes, &mut Report::default()).unwrap_err();
        assert_eq!((error.kind, &error.place), (kind, &Some(Place::Byte(start + at))), "{error}");
        assert!(error.what.contains(what), "{error}");
    }
}

#[test]
fn many_rows_take_linear_time() {
    let count = 200_000;
    let text = format!(
        "# {}\nOFF\n{count} {count} 0\n{}{}",
        "#".repeat(count),
        "0 0 0 # a vertex\n".repeat(count),
        "3 0 1 2\n".repeat(count)
    );
    assert_eq!(sound(&text).polygon_count(), count);
}
