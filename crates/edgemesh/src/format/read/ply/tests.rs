//! Small files in all three encodings.

use super::*;
use crate::format::read::error::ReadErrorKind;
use crate::index::NONE;
use crate::model::Segment;
use crate::report::{Place, WarningCode};

fn read(bytes: &[u8], report: &mut Report) -> Result<Model, ReadError> {
    read_ply(&Source { name: "test", folder: None, bytes }, report)
}

/// A text file with these header lines and rows.
fn ascii(header: &str, rows: &str) -> Vec<u8> {
    format!("ply\nformat ascii 1.0\n{header}\nend_header\n{rows}").into_bytes()
}

/// A binary file with this header, and with values whose bytes are given in
/// little-endian order.
fn binary(header: &str, is_big_endian: bool, values: &[&[u8]]) -> Vec<u8> {
    let order = if is_big_endian { "big" } else { "little" };
    let head = format!("ply\nformat binary_{order}_endian 1.0\n{header}\nend_header\n");
    let mut bytes = head.into_bytes();
    for value in values {
        match is_big_endian {
            true => bytes.extend(value.iter().rev()),
            false => bytes.extend(*value),
        }
    }
    bytes
}

const VERTICES: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z";
const FACES: &str = "element face 2\nproperty list uchar int vertex_indices";
const SQUARE: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

fn positions_of_square() -> [[f64; 3]; 4] {
    [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]]
}

/// A text file with four vertices and two faces; `rows` are those of the faces.
fn square(rows: &str) -> Vec<u8> {
    ascii(&format!("{VERTICES}\n{FACES}"), &format!("{SQUARE}{rows}"))
}

#[test]
fn polygons_keep_their_corners_and_lines() {
    let mut report = Report::default();
    let model = read(&square("4 0 1 2 3\n\n3 2 1 0"), &mut report).unwrap();
    assert_eq!(model.positions, positions_of_square());
    assert_eq!(model.corner_positions, [0, 1, 2, 3, 2, 1, 0]);
    assert_eq!(model.polygon_ends, [4, 7]);
    assert_eq!(model.polygon_lines, [14, 16]);
    assert!(model.colors.is_empty() && model.corner_normals.is_empty());
    assert!(report.warnings().is_empty());
    let crlf = String::from_utf8(square("4 0 1 2 3\n\n3 2 1 0")).unwrap().replace('\n', "\r\n");
    let model = read(crlf.as_bytes(), &mut report).unwrap();
    assert_eq!((model.corner_positions.len(), &model.polygon_lines[..]), (7, &[14, 16][..]));
}

/// Every type, a list to skip, and faces before vertices.
const MIXED: &str = "element note 1\nproperty list ushort double words\nproperty char end\n\
    element face 1\nproperty uchar kind\nproperty list uint short vertex_index\n\
    property list char ushort other\n\
    element vertex 3\nproperty double z\nproperty uchar alpha\nproperty int x\nproperty short y";

fn check_mixed(bytes: &[u8], face: Place) {
    let mut report = Report::default();
    let model = read(bytes, &mut report).unwrap();
    assert_eq!(model.positions, [[-70000., -2., 0.5], [0., 300., 1.], [5., 0., -1e300]]);
    assert_eq!(model.corner_positions, [0, 2, 1]);
    assert_eq!(model.polygon_place(0), face);
    let [warning] = report.warnings() else { panic!("{report:?}") };
    assert_eq!((warning.code, warning.count), (WarningCode::Unsupported, 1));
    assert_eq!(warning.place, Some(Place::Line(3)));
    assert!(warning.message.contains("'note' is unknown"), "{}", warning.message);
}

#[test]
fn elements_and_properties_come_in_any_order_and_type() {
    let rows = "2 0.5 1e9 -1\n9 3 0 2 1 1 7\n0.5 255 -70000 -2\n1 255 0 300\n-1e300 255 5 0\n";
    check_mixed(&ascii(MIXED, rows), Place::Line(17));
    let values: [&[u8]; 24] = [
        &2_u16.to_le_bytes(),
        &0.5_f64.to_le_bytes(),
        &1e9_f64.to_le_bytes(),
        &(-1_i8).to_le_bytes(),
        &[9],
        &3_u32.to_le_bytes(),
        &0_i16.to_le_bytes(),
        &2_i16.to_le_bytes(),
        &1_i16.to_le_bytes(),
        &1_i8.to_le_bytes(),
        &7_u16.to_le_bytes(),
        &0.5_f64.to_le_bytes(),
        &[255],
        &(-70000_i32).to_le_bytes(),
        &(-2_i16).to_le_bytes(),
        &1.0_f64.to_le_bytes(),
        &[255],
        &0_i32.to_le_bytes(),
        &300_i16.to_le_bytes(),
        &(-1e300_f64).to_le_bytes(),
        &[255],
        &5_i32.to_le_bytes(),
        &0_i16.to_le_bytes(),
        &[],
    ];
    check_mixed(&binary(MIXED, false, &values), Place::Face(1));
    check_mixed(&binary(MIXED, true, &values), Place::Face(1));
}

#[test]
fn vertices_bring_normals_colors_and_texture_coordinates() {
    let header = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property float nx\nproperty float ny\nproperty float nz\n\
        property uchar red\nproperty ushort green\nproperty float blue\n\
        property float s\nproperty float t\nproperty float u\n\
        element face 1\nproperty list uchar int vertex_indices";
    let rows = "0 0 0 0 0 2 255 0 0.5 0 1 9\n1 0 0 0 0 3 51 65535 2 0.25 0 9\n\
        0 1 0 0 0 -1 0 13107 0 1 1 9\n3 2 0 1\n";
    let model = read(&ascii(header, rows), &mut Report::default()).unwrap();
    assert_eq!(model.normals, [[0., 0., 2.], [0., 0., 3.], [0., 0., -1.]]);
    assert_eq!(model.colors, [[1., 0., 0.5, 1.], [0.2, 1., 2., 1.], [0., 0.2, 0., 1.]]);
    assert_eq!(model.texcoords, [[0., 1.], [0.25, 0.], [1., 1.]], "s comes before u");
    assert_eq!(model.corner_positions, [2, 0, 1]);
    assert_eq!(model.corner_normals, [2, 0, 1]);
    assert_eq!(model.corner_texcoords, [2, 0, 1]);
}

#[test]
fn colors_have_an_opacity_and_may_be_those_of_faces() {
    let header = |vertex: &str, face: &str| {
        format!(
            "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n{vertex}\
             element face 3\nproperty list uchar int vertex_indices\n{face}"
        )
    };
    let color = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    let of_vertices = header(&format!("property ushort alpha\n{color}"), color.trim_end());
    let rows = "0 0 0 65535 255 0 51\n1 0 0 13107 0 255 0\n0 1 0 0 0 0 0\n\
        3 0 1 2 255 0 0\n3 0 1 2 9 9 9\n3 2 1 0 9 9 9\n";
    let model = read(&ascii(&of_vertices, rows), &mut Report::default()).unwrap();
    assert_eq!(model.colors, [[1., 0., 0.2, 1.], [0., 1., 0., 0.2], [0., 0., 0., 0.]]);
    assert!(model.corner_colors.is_empty(), "those of vertices win");
    let of_faces = header("", &format!("{color}property float diffuse_alpha"));
    let rows = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 51 0.5\n3 0 1 2 255 0 51 0.5\n\
        3 2 1 0 0 255 0 1\n";
    let model = read(&ascii(&of_faces, rows), &mut Report::default()).unwrap();
    assert_eq!(model.colors, [[1., 0., 0.2, 0.5], [0., 1., 0., 1.]]);
    assert_eq!(model.corner_colors, [0, 0, 0, 0, 0, 0, 1, 1, 1]);
}

#[test]
fn incomplete_attributes_are_ignored() {
    let header = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property float nx\nproperty float ny\nproperty uchar red\nproperty float u\n\
        element face 1\nproperty list uchar int vertex_indices";
    let rows = "0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n3 0 1 2\n";
    let model = read(&ascii(header, rows), &mut Report::default()).unwrap();
    assert!(model.normals.is_empty() && model.colors.is_empty() && model.texcoords.is_empty());
    assert_eq!(model.corner(0).normal, NONE);
}

#[test]
fn strips_become_triangles_with_one_winding() {
    let header = format!("{VERTICES}\nelement tristrips 2\nproperty list int int vertex_indices");
    let rows = format!("{SQUARE}9 0 1 3 2 -1 3 2 1 -1\n5 -1 0 1 1 2\n");
    let mut report = Report::default();
    let model = read(&ascii(&header, &rows), &mut report).unwrap();
    let triangles = [[0, 1, 3], [3, 1, 2], [3, 2, 1], [0, 1, 1], [1, 1, 2]];
    assert_eq!(model.corner_positions, triangles.concat());
    assert_eq!(model.polygon_lines, [14, 14, 14, 15, 15]);
    assert!(report.warnings().is_empty(), "{report:?}");
    let short = format!("{SQUARE}6 0 1 -1 0 1 2\n0\n");
    let model = read(&ascii(&header, &short), &mut report).unwrap();
    assert_eq!((model.polygon_count(), report.count(WarningCode::Degenerate)), (1, 1));
}

#[test]
fn edges_are_segments() {
    let edges = "element edge 2\nproperty int vertex1\nproperty int vertex2\nproperty uchar red";
    let header = format!("{VERTICES}\n{edges}");
    let model = read(&ascii(&header, &format!("{SQUARE}0 2 9\n1 3 9\n")), &mut Report::default());
    let expected = [Segment { ends: [0, 2], line: 16 }, Segment { ends: [1, 3], line: 17 }];
    assert_eq!(model.unwrap().segments, expected);
}

#[test]
fn surplus_content_is_left_out_with_a_warning() {
    use WarningCode::{Degenerate, Syntax, Unsupported};
    let no_list = FACES.replace("vertex_indices", "corners");
    let no_ends = "element edge 1\nproperty int vertex1";
    for (file, code, line) in [
        (square("3 0 1 2 255 0 0\n3 0 1 3\n"), Syntax, 14),
        (square("3 0 1 2\n3 0 1 3\n\n more"), Syntax, 17),
        (square("2 0 1\n3 0 1 3\n"), Degenerate, 14),
        (ascii(&format!("{VERTICES}\n{no_list}"), &format!("{SQUARE}1 0\n0\n")), Unsupported, 7),
        (ascii(&format!("{VERTICES}\n{no_ends}"), &format!("{SQUARE}0\n")), Unsupported, 7),
    ] {
        let mut report = Report::default();
        read(&file, &mut report).unwrap();
        let [warning] = report.warnings() else { panic!("{report:?}") };
        assert_eq!((warning.code, warning.count), (code, 1));
        assert_eq!(warning.place, Some(Place::Line(line)));
    }
    let mut report = Report::default();
    read(&square("3 0 1 2\n3 0 1 3\n\n \r\n"), &mut report).unwrap();
    assert!(report.warnings().is_empty(), "blanks at the end are ignored");
}

#[test]
fn errors_of_text_have_their_line() {
    use ReadErrorKind::{Index, Number, Syntax, Truncated};
    for (rows, kind, line, what) in [
        ("3 0 1 -1\n3 0 1 2\n", Index, 14, "index -1 is not one of 4 vertices"),
        ("3 0 1 2\n3 0 1 4\n", Index, 15, "index 4 is not"),
        ("3 0 1 1.5\n3 0 1 2\n", Index, 14, "index 1.5"),
        ("3 0 1 nan\n3 0 1 2\n", Index, 14, "index NaN"),
        ("3 0 1 two\n3 0 1 2\n", Number, 14, "'two' is not a number"),
        ("3 0 1\n3 0 1 2\n", Syntax, 14, "row 1 of 'face' has too few values"),
        ("-3 0 1\n3 0 1 2\n", Syntax, 14, "a list has -3 values"),
        ("1e300 0\n3 0 1 2\n", Syntax, 14, "a list has 1000000"),
        ("1.5 0\n3 0 1 2\n", Syntax, 14, "a list has 1.5 values"),
        ("nan 0\n3 0 1 2\n", Syntax, 14, "a list has NaN values"),
        ("3 0 1 2\n", Truncated, 15, "ends in row 2 of 2 of 'face'"),
        ("3 0 1 2\n3 0 1", Truncated, 15, "ends in row 2 of 2 of 'face'"),
        ("", Truncated, 14, "2 rows of 'face' need at least 3 bytes, but 0 are left"),
    ] {
        let error = read(&square(rows), &mut Report::default()).unwrap_err();
        assert_eq!((error.kind, error.place.clone()), (kind, Some(Place::Line(line))), "{rows}");
        assert!(error.what.contains(what), "{error}");
    }
    let flat = ascii("element vertex 1\nproperty float x\nproperty float y", "0 0\n");
    let error = read(&flat, &mut Report::default()).unwrap_err();
    assert_eq!((error.kind, error.place), (Syntax, Some(Place::Line(3))));
}

#[test]
fn errors_of_bytes_have_their_offset() {
    use ReadErrorKind::{Index, Syntax, Truncated};
    let header = "element vertex 1\nproperty char x\nproperty char y\nproperty char z\n\
        element face 2\nproperty list char char vertex_indices";
    let file = |values: &[u8]| binary(header, false, &[values]);
    let start = file(&[]).len() as u64;
    for (values, kind, at, what) in [
        (&[0, 0, 0, 3, 0, 0, 1, 0][..], Index, 3, "index 1 is not"),
        (&[0, 0, 0, 0, 3, 0, 0, 255], Index, 4, "index -1 is not"),
        (&[0, 0, 0, 0, 255], Syntax, 4, "a list has -1 values"),
        (&[0, 0], Truncated, 0, "1 rows of 'vertex' need at least 3 bytes, but 2 are left"),
        (&[0, 0, 0, 9], Truncated, 3, "2 rows of 'face' need at least 2 bytes"),
        (&[0, 0, 0, 3, 0, 0, 0, 2, 0], Truncated, 7, "ends in row 2 of 2 of 'face'"),
        (&[0, 0, 0, 4, 0, 0, 0], Truncated, 3, "ends in row 1 of 2 of 'face'"),
    ] {
        let error = read(&file(values), &mut Report::default()).unwrap_err();
        let place = Some(Place::Byte(start + at));
        assert_eq!((error.kind, error.place.clone()), (kind, place), "{values:?}");
        assert!(error.what.contains(what), "{error}");
    }
    let mut report = Report::default();
    read(&file(&[0, 0, 0, 0, 0, b' ', 0, 7]), &mut report).unwrap();
    let [faces, rest] = report.warnings() else { panic!("{report:?}") };
    assert_eq!((faces.code, faces.count), (WarningCode::Degenerate, 2));
    assert_eq!((rest.code, &rest.place), (WarningCode::Syntax, &Some(Place::Byte(start + 7))));
}

#[test]
fn stated_counts_are_checked() {
    let huge = "element vertex 18446744073709551615\nproperty float x\nproperty float y\n\
        property float z";
    let no_values = "element nothing 18446744073709551615";
    for bytes in [ascii(huge, SQUARE), binary(huge, false, &[SQUARE.as_bytes()])] {
        let error = read(&bytes, &mut Report::default()).unwrap_err();
        assert_eq!(error.kind, ReadErrorKind::Truncated);
    }
    for bytes in [ascii(no_values, ""), binary(no_values, true, &[])] {
        assert_eq!(read(&bytes, &mut Report::default()).unwrap().positions.len(), 0);
    }
}

#[test]
fn many_corners_and_faces_take_linear_time() {
    let count = 200_000;
    let header = format!("{VERTICES}\nelement face {count}\nproperty list int int vertex_indices");
    let strip = " 0 1 2".repeat(count);
    let rows = format!("{SQUARE}{} {strip}\n{}", 3 * count, "3 0 1 2\n".repeat(count - 1));
    let model = read(&ascii(&header, &rows), &mut Report::default()).unwrap();
    assert_eq!((model.polygon_count(), model.corner_range(0).len()), (count, 3 * count));
    let strips = ascii(&header.replace("face", "tristrips"), &rows);
    let model = read(&strips, &mut Report::default()).unwrap();
    assert_eq!(model.polygon_count(), 3 * count - 2 + count - 1);
}
