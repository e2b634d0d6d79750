//! `viewer compare-strokes`: its output, which agrees with the paper.

use std::process::{Command, Stdio};

use testkit::locate::{program, workspace_root};

use crate::child::{one_error, run};

fn compare(model: &str, folder: &std::path::Path, more: &[&str]) -> std::process::Output {
    let model = workspace_root().join("models").join(model);
    let mut command = Command::new(program("viewer"));
    command.arg("-q").arg("compare-strokes").arg(model).arg("-o").arg(folder);
    run(command.args(more).stdout(Stdio::piped()))
}

#[test]
fn a_folder_that_cannot_be_made_is_said_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("taken");
    std::fs::write(&file, "a file").unwrap();
    let output = compare("cube.obj", &file, &["--frames", "2"]);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    one_error(&output, &["taken", "cannot be created"]).unwrap();
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "a file", "nothing is lost");
}

#[test]
fn unknown_paths_and_brushes_are_told_with_those_there_are() {
    let folder = tempfile::tempdir().unwrap();
    for (option, name) in [("--path", "turntable"), ("--brush", "charcoal")] {
        let output = compare("cube.obj", folder.path(), &[option, "nothing"]);
        assert_eq!(output.status.code(), Some(2));
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(text.contains(name), "{text}");
    }
}

#[cfg(feature = "gpu")]
mod with_adapter {
    use std::collections::BTreeMap;

    use super::*;

    /// Sums of a measure by parameterization, weighted by length.
    fn means(table: &str, column: &str, path: &str) -> BTreeMap<String, f64> {
        let mut lines = table.lines();
        let header: Vec<&str> = lines.next().unwrap().split(',').collect();
        let at = |name: &str| header.iter().position(|known| *known == name).unwrap();
        let mut sums: BTreeMap<String, (f64, f64)> = BTreeMap::new();
        for line in lines {
            let cells: Vec<&str> = line.split(',').collect();
            assert_eq!(cells.len(), header.len(), "{line}");
            if cells[at("path")] != path {
                continue;
            }
            let number = |name: &str| cells[at(name)].parse::<f64>().unwrap();
            let sum = sums.entry(cells[at("parameterization")].to_owned()).or_default();
            sum.0 += number(column) * number("length_px");
            sum.1 += number("length_px");
        }
        sums.into_iter().map(|(way, (sum, length))| (way, sum / length)).collect()
    }

    /// Section 4: in object space the brush sticks to the surface and breaks at every edge;
    /// in screen space it is nearly whole, follows the view sideways, and slides when the
    /// view turns.
    #[test]
    fn the_tables_say_what_the_paper_says() {
        let folder = tempfile::tempdir().unwrap();
        let settings = ["--frames", "4", "--size", "512x512", "--brush", "pen", "--width", "4"];
        let output = compare("torus_knot.obj", folder.path(), &settings);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
        let table = read("strokes.csv");
        let [object, screen, chained] = ["object-space", "screen-space", "chained"];
        for path in ["turntable", "pan", "dolly", "zoom", "roll"] {
            let of = |column: &str| means(&table, column, path);
            let (breaks, slide, stretch) =
                (of("breaks_per_1000_px"), of("slide_px"), of("stretch_log2"));
            assert!(breaks[object] > 30.0, "{path}: {breaks:?}");
            assert!(
                breaks[chained] * 10.0 < breaks[screen].min(breaks[object]),
                "{path}: {breaks:?}"
            );
            assert!(slide[object] < 0.1, "{path}: {slide:?}");
            assert!(stretch[object] < 0.01 && stretch[chained] < 0.5, "{path}: {stretch:?}");
        }
        let slide = |path: &str| means(&table, "slide_px", path)[screen];
        assert!(slide("roll") > 3.0 * slide("pan"), "{} and {}", slide("roll"), slide("pan"));
        let picture = image::open(folder.path().join("torus_knot-pen.png")).unwrap();
        assert_eq!((picture.width(), picture.height()), (3 * 512, 2 * 512));
        let page = read("index.html");
        assert!(
            page.contains("data:image/png;base64,") && page.contains("<svg"),
            "numbers of pictures and plots"
        );
        assert!(!page.contains("http"), "the page refers to the web");
    }
}
