//! Whole scenes: of both versions, hostile ones, and those of the corpus.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use std::{env, fs};

use super::parse::{Document, Origin, decode};
use crate::build::{BuildOptions, build_edge_mesh};
use crate::edge_mesh::EdgeFlags;
use crate::format::read::source::Source;
use crate::format::read::{Format, ReadError, ReadErrorKind, read_model, read_model_bytes};
use crate::model::Model;
use crate::report::{Place, RepairKind, Report, WarningCode};

/// Reads a scene; a text without a header is VRML 97.
pub(super) fn read(text: &str) -> Result<(Model, Report), ReadError> {
    let header = if text.starts_with("#VRML") { "" } else { "#VRML V2.0 utf8\n" };
    read_model_bytes("test.wrl", format!("{header}{text}").as_bytes(), Format::Wrl)
}

/// The document of a scene without faults.
pub(super) fn parsed(text: &str) -> Document {
    let source = Source { name: "test.wrl", folder: None, bytes: text.as_bytes() };
    decode(Origin::of_model(&source), source.bytes, &mut Report::default()).unwrap()
}

/// Reads a scene without warnings.
pub(super) fn sound(text: &str) -> Model {
    let (model, report) = read(text).unwrap();
    assert!(report.warnings().is_empty(), "{report:?}");
    model
}

/// The indices of the corners of each face.
pub(super) fn faces_of(model: &Model) -> Vec<Vec<u32>> {
    let corners = |polygon| model.corner_positions[model.corner_range(polygon)].to_vec();
    (0..model.polygon_count()).map(corners).collect()
}

/// The positions of the corners of each face.
fn face_positions(model: &Model) -> Vec<Vec<[f64; 3]>> {
    let place = |index: u32| model.positions[index as usize];
    faces_of(model).into_iter().map(|face| face.into_iter().map(place).collect()).collect()
}

/// The diffuse color of each face.
pub(super) fn diffuse_of_faces(model: &Model) -> Vec<Option<[f32; 3]>> {
    model.per_polygon(|run| model.materials.get(run.material as usize).and_then(|m| m.diffuse))
}

const CUBE_V1: &str = "#VRML V1.0 ascii
    Separator {
      Material { diffuseColor 1 0 0 }
      Translation { translation 0 0 3 }
      Rotation { rotation 0 1 0 0.5 }
      Cube { depth 4 }
      ShapeHints { vertexOrdering CLOCKWISE creaseAngle 0 }
      Coordinate3 { point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0 ] }
      IndexedFaceSet { coordIndex [ 3, 2, 1, 0 ] }
    }
    Cube { }";

const CUBE_V2: &str = "#VRML V2.0 utf8
    Transform {
      translation 0 0 3
      rotation 0 1 0 0.5
      children [
        Shape {
          appearance DEF Red Appearance { material Material { diffuseColor 1 0 0 } }
          geometry Box { size 2 2 4 }
        }
        Shape {
          appearance USE Red
          geometry IndexedFaceSet {
            ccw FALSE
            coord Coordinate { point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0 ] }
            coordIndex [ 3 2 1 0 -1 ]
          }
        }
      ]
    }
    Shape { geometry Box { } }";

#[test]
fn both_versions_make_the_same_cubes() {
    let [one, two] = [CUBE_V1, CUBE_V2].map(sound);
    assert_eq!((one.positions.len(), one.polygon_count()), (20, 13));
    assert_eq!(one.positions, two.positions);
    assert_eq!(face_positions(&one), face_positions(&two));
    assert_eq!(diffuse_of_faces(&one), diffuse_of_faces(&two));
    assert_eq!(diffuse_of_faces(&one)[12], None, "the last cube has no material");
    let smoothing = |model: &Model| model.per_polygon(|run| run.smoothing);
    assert_eq!(smoothing(&one), smoothing(&two));
}

#[test]
fn the_column_is_the_same_in_both_versions() {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    let [two, one] = ["column.wrl", "column_v1.wrl"].map(|name| {
        let (model, report) = read_model(&models.join(name)).unwrap();
        assert!(report.warnings().is_empty(), "{name}: {report:?}");
        model
    });
    assert_eq!((two.positions.len(), two.polygon_count()), (2 * (8 + 48) + 72, 2 * (6 + 26) + 38));
    assert_eq!(face_positions(&two), face_positions(&one));
    assert_eq!(two.groups, one.groups);
    let names = |model: &Model| -> Vec<Option<String>> {
        model.per_polygon(|run| Some(model.materials.get(run.material as usize)?.name.clone()))
    };
    assert_eq!(names(&two), names(&one));
    assert!(names(&two).iter().all(Option::is_some));
    assert_eq!(two.per_polygon(|run| run.smoothing), one.per_polygon(|run| run.smoothing));
}

#[test]
fn the_column_is_made_of_solids() {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    let (model, mut report) = read_model(&models.join("column.wrl")).unwrap();
    let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
    assert!(report.warnings().is_empty(), "{report:?}");
    assert_eq!(report.repair_count(RepairKind::FlippedFaces), 0);
    assert_eq!(mesh.counts.components, 5);
    assert!(mesh.records.iter().all(|record| record.flags().contains(EdgeFlags::SOLID)));
}

#[test]
fn headers_are_checked() {
    let kind = |text: &str| read_model_bytes("a", text.as_bytes(), Format::Wrl).unwrap_err().kind;
    assert_eq!(kind("Shape { geometry Box { } }"), ReadErrorKind::Format);
    assert_eq!(kind("#VRML V3.0 utf8\n"), ReadErrorKind::Format);
    assert_eq!(kind("#VRML"), ReadErrorKind::Format);
    assert_eq!(kind("#VRML V2.0 utf8"), ReadErrorKind::Empty);
    let bytes = b"\xef\xbb\xbf#VRML V2.0 utf8 \r\rShape { geometry Box { } }";
    let (model, _) = read_model_bytes("a", bytes, Format::Wrl).unwrap();
    assert_eq!(model.polygon_lines, [3; 6]);
}

/// A hundred thousand nodes are read quickly, and without a deep stack.
#[test]
fn large_scenes_take_linear_time() {
    const COUNT: usize = 100_000;
    let nested =
        |open: &str, inside: &str, close: &str| open.repeat(COUNT) + inside + &close.repeat(COUNT);
    let triangle = "geometry IndexedFaceSet { coord Coordinate { point [ 0 0 0 1 0 0 0 1 0 ] }
        coordIndex [ 0 1 2 ] }";
    let shared = format!("DEF A Shape {{ {triangle} }}\n") + &"USE A ".repeat(COUNT);
    let scenes = [
        nested("Group { children [ ", "Shape { geometry Box { } } ", "] } "),
        nested("Transform { children ", "Shape { geometry Box { } } ", "} "),
        format!("#VRML V1.0 ascii\n{}", nested("Separator { ", "Cube { } ", "} ")),
        format!("#VRML V1.0 ascii\nCube {{ }} {}", nested("Translation { } Group { ", "", "} ")),
        "Shape { geometry Box { } } ".to_owned() + &"Unknown { a 1 } ".repeat(COUNT),
        shared,
        format!("PROTO P [ ] {} Shape {{ {triangle} }}", nested("{ ", "", "} ")),
    ];
    for scene in scenes {
        let start = Instant::now();
        let (model, _) = read(&scene).unwrap();
        let elapsed = start.elapsed();
        assert!(model.polygon_count() > 0);
        assert!(elapsed < Duration::from_secs(10), "{elapsed:?}: {}", &scene[..60]);
    }
}

#[test]
fn scenes_that_generate_too_much_are_refused() {
    let doubling = |first: &str| {
        let levels = (1..40).map(|level| {
            let below = level - 1;
            format!("DEF L{level} Group {{ children [ USE L{below} USE L{below} ] }}\n")
        });
        format!("DEF L0 {first}\n{}", levels.collect::<String>())
    };
    let grid = "Shape { geometry Extrusion { ".to_owned()
        + &format!("spine [ {} ] ", "0 1 2 ".repeat(20_000))
        + &format!("crossSection [ {} ] }} }}", "1 2 ".repeat(20_000));
    for scene in [doubling("Group { }"), doubling("Shape { geometry Sphere { } }"), grid] {
        assert_eq!(read(&scene).unwrap_err().kind, ReadErrorKind::Size, "{}", &scene[..40]);
    }
}

/// `EDGEMESH_SHARED`, else `../shared` beside the workspace.
fn corpus() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let folder = env::var_os("EDGEMESH_SHARED").map_or(beside, PathBuf::from);
    let corpus = folder.join("corpus");
    if corpus.is_dir() {
        return Some(corpus);
    }
    #[expect(clippy::print_stderr, reason = "reports what was left out")]
    {
        eprintln!("left out the VRML corpus: set EDGEMESH_SHARED to the shared files");
    }
    None
}

fn scenes(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(scenes(&path));
        } else if Format::of_name(&path) == Some(Format::Wrl) {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// Files that draw nothing, and what they have instead.
const NOTHING_DRAWN: [(&str, &str); 7] = [
    ("prototypes/proto_nested.wrl", "all shapes are in prototypes"),
    ("prototypes/proto_nodes.wrl", "all shapes but texts are in prototypes"),
    ("prototypes/proto_nodes_by_external.wrl", "all shapes are in prototypes"),
    ("vrml_1/inline_test.wrl", "only inlined files, which are not in the corpus"),
    ("vrml_1/relative_names.wrl", "only an inlined file, which is not in the corpus"),
    ("vrml_1/subdir1/relative_inline2.wrl", "only an inlined file, which is not in the corpus"),
    ("castle_extensions/inline_load_control_test_1.wrl", "only a text and sensors"),
];

/// The numbers of vertices, polygons and segments of the others. Those of face sets were
/// counted in the text; a sphere has 266 and 288, a cone 25 and 25, a cylinder 48 and 26.
const DRAWN: [(&str, [usize; 3]); 19] = [
    ("assimp/HelloWorld.wrl", [266, 288, 0]),
    ("assimp/MotionCaptureROM.WRL", [1042, 2000, 0]),
    ("assimp/Wuson.wrl", [3205, 3732, 0]),
    ("prototypes/proto_other.wrl", [3 * 266, 3 * 288, 0]),
    ("castle_extensions/multi_root.wrl", [266 + 25 + 48, 288 + 25 + 26, 0]),
    ("vrml_1/concave.wrl", [10, 1, 0]),
    ("vrml_1/cones_gzip_compressed.wrl.gz", [185, 54, 20]),
    ("vrml_1/flat_triangles_octree_test.wrl", [87, 88, 0]),
    ("vrml_1/kings_head_transparent.wrl", [8, 6, 0]),
    ("vrml_1/shape_hints.wrl", [4 * (8 + 266), 4 * (6 + 288), 0]),
    ("vrml_2/extrusion_concave_cap.wrl", [48, 22, 0]),
    ("vrml_2/indexed_line_set.wrl", [48, 0, 48]),
    ("vrml_2/kings_head_transparent.wrl", [8, 6, 0]),
    ("vrml_2/normals.wrl", [16, 4, 0]),
    ("vrml_2/relative_names.wrl", [618, 634, 0]),
    ("vrml_2/smoothing_independent_of_faces_order.wrl", [28_608, 30_480, 352]),
    ("vrml_2/subdir1/relative_inline2.wrl", [618, 634, 0]),
    ("subdir2/texture_test.wrl", [618, 634, 0]),
    ("vrml_2/teapot.wrl", [1563, 1546, 0]),
];

#[test]
fn every_file_of_the_corpus_is_read() {
    let Some(corpus) = corpus() else { return };
    let files = scenes(&corpus.join("wrl"));
    assert_eq!(files.len(), DRAWN.len() + NOTHING_DRAWN.len(), "{files:?}");
    for file in &files {
        let start = Instant::now();
        let result = read_model(file);
        let elapsed = start.elapsed();
        assert!(elapsed < Duration::from_secs(2), "{} took {elapsed:?}", file.display());
        let found = result
            .map(|(model, _)| [model.positions.len(), model.polygon_count(), model.segments.len()]);
        match DRAWN.iter().find(|(name, _)| file.ends_with(name)) {
            Some((name, counts)) => assert_eq!(found, Ok(*counts), "{name}"),
            None => {
                let error = found.unwrap_err();
                assert_eq!(error.kind, ReadErrorKind::Empty, "{error}");
                assert!(NOTHING_DRAWN.iter().any(|(name, _)| file.ends_with(name)), "{error}");
            }
        }
    }
}

#[test]
fn malformed_files_give_the_expected_errors() {
    let Some(corpus) = corpus() else { return };
    let folder = corpus.join("malformed/gen/wrl");
    let failure = |name: &str| read_model(&folder.join(name)).unwrap_err();
    let (model, report) = read_model(&folder.join("ok_quad.wrl")).unwrap();
    assert!(report.warnings().is_empty());
    assert_eq!((model.positions.len(), faces_of(&model)), (4, vec![vec![0, 1, 2, 3]]));
    let unclosed = failure("unclosed_bracket.wrl");
    assert_eq!((unclosed.kind, unclosed.place), (ReadErrorKind::Syntax, Some(Place::Line(2))));
    let cycle = failure("inline_self.wrl");
    assert_eq!((cycle.kind, cycle.place), (ReadErrorKind::Cycle, Some(Place::Line(2))));
    assert_eq!(failure("no_header.wrl").kind, ReadErrorKind::Format);
}

#[test]
fn files_cut_short_or_changed_never_panic() {
    let whole = CUBE_V2.as_bytes();
    for bytes in [CUBE_V1.as_bytes(), whole] {
        for end in 0..bytes.len() {
            let cut = read_model_bytes("cut.wrl", &bytes[..end], Format::Wrl);
            assert!(cut.is_err() || end > bytes.len() / 2, "{end}");
            for byte in *b"{}[]\"#-9 " {
                let mut changed = bytes.to_vec();
                changed[end] = byte;
                let result = read_model_bytes("changed.wrl", &changed, Format::Wrl);
                let is_internal = result.is_err_and(|error| error.kind == ReadErrorKind::Internal);
                assert!(!is_internal, "{byte} at {end}");
            }
        }
    }
}

#[test]
fn unsupported_nodes_give_warnings() {
    let text = "Shape { geometry Box { } } Shape { geometry Text { string \"x\" } }
        Shape { geometry PointSet { } } Unknown { } PROTO P [ ] { } P { } Viewpoint { }
        DEF T TimeSensor { } DEF I PositionInterpolator { } ROUTE T.a TO I.b Fog { }";
    let (_, report) = read(text).unwrap();
    assert_eq!(report.count(WarningCode::Unsupported), 5);
    let error = read("PROTO P [ ] { Box { } }\nP { }").unwrap_err();
    assert_eq!((error.kind, error.place), (ReadErrorKind::Empty, Some(Place::Line(2))));
    assert!(error.what.contains("PROTO P"), "{}", error.what);
    assert_eq!(report.warnings().len(), 1);
    let text = "#VRML V1.0 ascii\nCube { } AsciiText { } PointSet { } Info { } Unknown { }";
    assert_eq!(read(text).unwrap().1.count(WarningCode::Unsupported), 3);
}
