//! Whole files.

use super::sample::{MODEL, VERTICES, model_part, read, read_parts, square};
use super::*;
use crate::format::read::error::ReadErrorKind;
use crate::index::NONE;
use crate::report::{Place, WarningCode};

/// An item of the build that places object `id`.
fn item(id: u32) -> String {
    format!(r#"<item objectid="{id}"/>"#)
}

/// The corners of the sample's square, moved.
fn moved([x, y, z]: [f64; 3]) -> [[f64; 3]; 4] {
    [[0., 0.], [1., 0.], [1., 1.], [0., 1.]].map(|[a, b]| [x + a, y + b, z])
}

#[test]
fn items_place_objects() {
    let items = format!(
        r#"{}<item objectid="1" transform="1 0 0 0 1 0 0 0 1 5 6 7" printable="0"/>"#,
        item(1)
    );
    let (model, report) = read(&square(r#"id="1" name="plate &amp; base""#), &items).unwrap();
    assert_eq!(model.positions, [moved([0.0; 3]), moved([5., 6., 7.])].concat());
    assert_eq!(model.corner_positions, [0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7]);
    assert_eq!(model.groups, ["plate & base"; 2]);
    assert_eq!(model.per_polygon(|run| run.group), [0, 0, 1, 1]);
    assert!(model.is_triangles() && model.materials.is_empty());
    assert!(report.warnings().is_empty(), "{report:?}");
}

#[test]
fn the_model_part_is_found_by_its_relationship() {
    let rels = |target: &str| {
        format!(
            r#"<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/a.png" Id="0" Type="http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail"/>
<Relationship Target="{target}" Id="1" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>"#
        )
    };
    let model = model_part(&square(r#"id="1""#), &item(1));
    for (name, target) in [
        ("3D/other.model", "/3D/other.model"),
        ("3D/other.model", "3D/Other.model"),
        ("3D/3dmodel.model", "/3D/none.model"),
        ("3D/3dmodel.model", "../../3D/3dmodel.model"),
    ] {
        let (found, report) =
            read_parts(&[("_rels/.rels", &rels(target)), (name, &model)]).unwrap();
        assert_eq!(found.polygon_count(), 2, "{target}");
        assert!(report.warnings().is_empty());
    }
    let (_, report) = read_parts(&[("_rels/.rels", "<a"), ("3D/3dmodel.model", &model)]).unwrap();
    assert_eq!(report.count(WarningCode::Syntax), 1, "malformed relationships");
    let error = read_parts(&[("word/document.xml", "<a/>")]).unwrap_err();
    assert_eq!(error.kind, ReadErrorKind::Format);
    assert!(error.what.contains("without a 3D model part"), "{error}");
}

#[test]
fn components_are_placed_by_all_transforms_around_them() {
    let resources = format!(
        r#"{}<object id="2"><components>
        <component objectid="1" transform="1 0 0 0 1 0 0 0 1 10 0 0"/>
        <component objectid="1"/></components></object>
        <object id="3" name="pair"><components>
        <component objectid="2" transform="0 1 0 -1 0 0 0 0 1 0 0 0"/></components></object>"#,
        square(r#"id="1""#)
    );
    let items = r#"<item objectid="3" transform="1 0 0 0 1 0 0 0 1 0 0 3"/>"#;
    let (model, report) = read(&resources, items).unwrap();
    // Shifted by 10 along x, turned by 90 degrees around z, shifted by 3 along z.
    assert_eq!(
        model.positions[..4],
        [[0., 10., 3.], [0., 11., 3.], [-1., 11., 3.], [-1., 10., 3.]]
    );
    assert_eq!(model.positions[4..6], [[0., 0., 3.], [0., 1., 3.]]);
    assert_eq!(model.groups, ["pair", "pair"], "the innermost name");
    assert!(report.warnings().is_empty());
}

#[test]
fn mirrored_objects_keep_their_outside() {
    let items = r#"<item objectid="1" transform="-1 0 0 0 1 0 0 0 1 0 0 0"/>"#;
    let (model, _) = read(&square(r#"id="1""#), items).unwrap();
    assert_eq!(model.corner_positions, [0, 2, 1, 0, 3, 2]);
    assert_eq!(model.groups, ["object 1"]);
    let items = r#"<item objectid="1" transform="-1 0 0 0 -1 0 0 0 1 0 0 0"/>"#;
    let (model, _) = read(&square(r#"id="1""#), items).unwrap();
    assert_eq!(model.corner_positions, [0, 1, 2, 0, 2, 3]);
}

#[test]
fn triangles_have_materials_and_colors() {
    let resources = format!(
        r##"<basematerials id="5"><base name="steel" displaycolor="#808080"/>
        <base name="glass" displaycolor="#0000FF33"/><base name="unused" displaycolor="#111111"/>
        </basematerials>
        <m:colorgroup id="6"><m:color color="#FF0000"/><m:color color="#FF0000"/></m:colorgroup>
        <object id="1" pid="5" pindex="1"><mesh>{VERTICES}<triangles>
        <triangle v1="0" v2="1" v3="2"/>
        <triangle v1="0" v2="2" v3="3" p1="0" p2="0" p3="0"/>
        <triangle v1="0" v2="1" v3="3" pid="6" p1="0"/>
        <triangle v1="1" v2="2" v3="3" pid="6" p1="1"/>
        </triangles></mesh></object>"##
    );
    let (model, report) = read(&resources, &item(1)).unwrap();
    let found: Vec<_> =
        model.materials.iter().map(|one| (one.name.as_str(), one.diffuse, one.opacity)).collect();
    let gray = 128.0 / 255.0;
    assert_eq!(
        found,
        [
            ("glass", Some([0., 0., 1.]), Some(0.2)),
            ("steel", Some([gray; 3]), None),
            ("", Some([1., 0., 0.]), None)
        ]
    );
    assert_eq!(model.per_polygon(|run| run.material), [0, 1, 2, 2]);
    assert!(report.warnings().is_empty(), "{report:?}");
}

#[test]
fn what_is_left_out_is_counted() {
    use WarningCode::{Material, Syntax, Unsupported};
    let triangle = |more: &str| format!(r#"<triangle v1="0" v2="1" v3="2" {more}/>"#);
    let mesh = |triangles: &str| {
        format!(
            r#"<object id="1"><mesh>{VERTICES}<triangles>{triangles}</triangles></mesh></object>"#
        )
    };
    let blend = triangle(r#"pid="6" p1="0" p2="1" p3="1""#).repeat(3);
    let colors = r##"<m:colorgroup id="6"><m:color color="#FF0000"/><m:color color="#00FF00"/></m:colorgroup>"##;
    let support = square(r#"id="2" type="support""#);
    let square = square(r#"id="1""#);
    let textures = r#"<m:texture2d id="8" path="/a.png"/><m:texture2dgroup id="7" texid="8"/>"#;
    for (resources, items, code, count) in [
        (format!("{colors}{}", mesh(&blend)), item(1), Unsupported, 3),
        (mesh(&triangle(r#"pid="9" p1="0""#)), item(1), Material, 1),
        (format!("{colors}{}", mesh(&triangle(r#"pid="6" p1="2""#))), item(1), Material, 1),
        (format!("{textures}{}", mesh(&triangle(r#"pid="7" p1="0""#))), item(1), Unsupported, 1),
        (format!("{support}{square}"), format!("{}{}{0}", item(2), item(1)), Unsupported, 2),
        (square.replace("</mesh>", "<beamlattice/></mesh>"), item(1), Unsupported, 1),
        (square.clone(), String::new(), Syntax, 1),
    ] {
        let (model, report) = read(&resources, &items).unwrap();
        assert!(model.polygon_count() > 0 && model.per_polygon(|run| run.material)[0] != 9);
        let [warning] = report.warnings() else { panic!("{resources}: {report:?}") };
        assert_eq!((warning.code, warning.count), (code, count), "{resources}");
    }
    let (model, _) = read(&mesh(&triangle(r#"pid="9" p1="0""#)), &item(1)).unwrap();
    assert_eq!(model.per_polygon(|run| run.material), [NONE]);
}

#[test]
fn without_a_build_whole_objects_are_drawn() {
    let pair = r#"<object id="2"><components><component objectid="1"/><component objectid="1"
        transform="1 0 0 0 1 0 0 0 1 2 0 0"/></components></object>"#;
    let (model, _) = read(&format!("{}{pair}", square(r#"id="1""#)), "").unwrap();
    assert_eq!(model.polygon_count(), 4, "object 1 is only a component");
}

#[test]
fn other_parts_hold_objects() {
    let inner = model_part(&square(r#"id="7" name="inner""#), &item(7));
    let root = model_part(
        r#"<object id="1"><components><component p:path="/3D/Objects/A.model" objectid="7"
            transform="1 0 0 0 1 0 0 0 1 1 0 0"/></components></object>"#,
        r#"<item objectid="1"/><item p:path="/3D/objects/a.model" objectid="7"/>"#,
    );
    let parts = [("3D/3dmodel.model", root.as_str()), ("3D/Objects/a.model", &inner)];
    let (model, report) = read_parts(&parts).unwrap();
    assert_eq!(model.positions, [moved([1., 0., 0.]), moved([0.; 3])].concat());
    assert_eq!(model.groups, ["inner"; 2]);
    assert!(report.warnings().is_empty(), "only the first build counts: {report:?}");
    let inch = inner.replace("<model", r#"<model unit="inch""#);
    let (model, _) = read_parts(&[parts[0], ("3D/Objects/a.model", &inch)]).unwrap();
    let [x, y, _] = model.positions[2];
    assert!((x - 26.4).abs() < 1e-12 && (y - 25.4).abs() < 1e-12, "in millimeters: {x}, {y}");
    let error = read_parts(&parts[..1]).unwrap_err();
    assert_eq!(error.place, Some(Place::Part("/3D/Objects/A.model".into())), "{error}");
    let missing = inner.replace(r#"id="7""#, r#"id="8""#).replace(&item(7), "");
    let error = read_parts(&[parts[0], ("3D/Objects/a.model", &missing)]).unwrap_err();
    assert!(error.what.contains("object 7, which is not in /3D/"), "{error}");
}

#[test]
fn units_do_not_change_positions() {
    for unit in ["micron", "millimeter", "centimeter", "inch", "foot", "meter"] {
        let text = model_part(&square(r#"id="1""#), &item(1));
        let text = text.replace("<model", &format!(r#"<model unit="{unit}""#));
        let (model, _) = read_parts(&[("3D/3dmodel.model", &text)]).unwrap();
        assert_eq!(model.positions, moved([0.; 3]), "{unit}");
    }
}

#[test]
fn extensions_that_change_the_surface_are_refused_by_name() {
    let read_with = |attributes: &str| {
        let text = model_part(&square(r#"id="1""#), &item(1));
        read_parts(&[(
            "3D/3dmodel.model",
            &text.replace("<model", &format!("<model {attributes}")),
        )])
    };
    assert!(read_with(r#"requiredextensions="m p""#).is_ok());
    let lattice = "http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02";
    let error = read_with(&format!(r#"requiredextensions="p b" xmlns:b="{lattice}""#)).unwrap_err();
    assert_eq!(error.kind, ReadErrorKind::Extension);
    assert!(error.what.contains(lattice), "{error}");
    let error = read_with(r#"requiredextensions="none""#).unwrap_err();
    assert!(error.what.contains("the extension none"), "{error}");
    assert!(read_with(&format!(r#"xmlns:b="{lattice}""#)).is_ok(), "not required");
}

#[test]
fn errors_have_their_line() {
    use ReadErrorKind::{Cycle, Format, Index, Number, Syntax, Truncated};
    let square = square(r#"id="1""#);
    let text = |resources: &str, items: &str| model_part(&format!("\n{resources}"), items);
    for (text, kind, line, what) in [
        (String::new(), Syntax, 1, "has no element"),
        ("<html/>".into(), Format, 1, "the root is 'html'"),
        ("<model/>".into(), Format, 1, "the root is 'model'"),
        (text(&square.replace("x=\"0\"", ""), ""), Syntax, 6, "a vertex needs x, y and z"),
        (text(&square.replace("\"1\"", "\"one\""), ""), Number, 6, "id is 'one'"),
        (text(&square.replace("x=\"1\"", "x=\"1,5\""), ""), Number, 6, "x is '1,5'"),
        (
            text(&square.replace("v3=\"3\"", "v3=\"4\""), ""),
            Index,
            6,
            "vertex 4 (counted from 0) of 4",
        ),
        (text(&square.replace("v3=\"3\"", "v3=\"-1\""), ""), Number, 6, "v3 is '-1'"),
        (text(&square.replace("v3=\"3\"", ""), ""), Syntax, 6, "needs v1, v2 and v3"),
        (text(&square, "\n<item/>"), Syntax, 8, "'item' lacks 'objectid'"),
        (text(&square, "\n<item objectid=\"2\"/>"), Syntax, 8, "object 2, which is not in 3D"),
        (text(&square, "<item objectid=\"1\" transform=\"1\"/>"), Number, 7, "twelve numbers"),
        (text(&format!("{square}\n{square}"), ""), Syntax, 7, "two objects have the id 1"),
        (
            text("<m:colorgroup id=\"1\"><m:color color=\"red\"/></m:colorgroup>", ""),
            Syntax,
            6,
            "'red' is not a color",
        ),
        (text(&square, "").replace("</resources>", ""), Syntax, 8, "malformed XML"),
        (text(&square, "").replace("</model>", ""), Truncated, 8, "ends within an element"),
        (
            text(&square, "").replace("<model", "<model unit=\"mile\""),
            Syntax,
            4,
            "'mile' is not a unit",
        ),
        (text("<a>".repeat(200).as_str(), ""), Syntax, 6, "more than 100 elements"),
        (
            text(
                "<object id=\"1\"><components><component objectid=\"2\"/></components></object>\n<object id=\"2\"><components><component objectid=\"1\"/></components></object>",
                &item(1),
            ),
            Cycle,
            6,
            "a component of itself",
        ),
    ] {
        let error = read_parts(&[("3D/3dmodel.model", &text)]).unwrap_err();
        let place = Some(Place::Part(format!("3D/3dmodel.model:{line}")));
        assert_eq!((error.kind, &error.place), (kind, &place), "{error}");
        assert!(error.what.contains(what), "{error}");
    }
    let text = format!("{MODEL}>").encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>();
    let bytes = [b"\xff\xfe", &text[..]].concat();
    let bytes = super::sample::zip(&[("3D/3dmodel.model", &bytes)], super::sample::Packing::Stored);
    let source = Source { name: "test.3mf", folder: None, bytes: &bytes };
    let error = read_3mf(&source, &mut Report::default()).unwrap_err();
    assert!(error.what.contains("UTF-16"), "{error}");
}

#[test]
fn doubled_components_are_counted_and_not_placed() {
    let mut resources = square(r#"id="1""#);
    for id in 2..60 {
        let component = format!(r#"<component objectid="{}"/>"#, id - 1);
        resources += &format!(
            r#"<object id="{id}"><components>{component}{component}</components></object>"#
        );
    }
    let error = read(&resources, &item(59)).unwrap_err();
    assert_eq!(error.kind, ReadErrorKind::Size);
    // Two triangles, doubled 58 times.
    assert!(error.what.contains(&format!("places {} triangles", 1_u64 << 59)), "{error}");
    let (model, _) = read(&resources, &item(11)).unwrap();
    assert_eq!(model.polygon_count(), 2 << 10);
    let empty = resources.replace("<triangle ", "<nothing ");
    assert_eq!(read(&empty, &item(59)).unwrap_err().kind, ReadErrorKind::Size);
}

#[test]
fn long_chains_and_many_lines_take_linear_time() {
    let mut resources = square(r#"id="1""#);
    for id in 2..50_000 {
        resources += &format!(
            "\n<object id=\"{id}\"><components><component objectid=\"{}\"/></components></object>",
            id - 1
        );
    }
    let (model, _) = read(&resources, &item(49_999)).unwrap();
    assert_eq!(model.polygon_count(), 2);
    let colors: String = (0..50_000).map(|k| format!("<m:color color=\"#{k:06x}\"/>")).collect();
    let triangles: String = (0..50_000)
        .map(|k| format!("<triangle v1=\"0\" v2=\"1\" v3=\"2\" pid=\"2\" p1=\"{k}\" p2=\"1\"/>\n"))
        .collect();
    let resources = format!(
        r#"<m:colorgroup id="2">{colors}</m:colorgroup><object id="1"><mesh>{VERTICES}<triangles>
        {triangles}</triangles></mesh></object>"#
    );
    let (model, _) = read(&resources, &item(1)).unwrap();
    assert_eq!((model.polygon_count(), model.materials.len()), (50_000, 50_000));
}
