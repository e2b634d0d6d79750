//! Processing of detected lines: dilation, erosion, flooding, line widths, smooth rims.

use crate::gpu_edges::of_pattern;

/// Texels per side.
const SIDE: i32 = 32;

type Texels = Vec<[f32; 4]>;

fn at(texels: &[[f32; 4]], column: i32, row: i32) -> [f32; 4] {
    let inside = |place: i32| place.clamp(0, SIDE - 1);
    texels[usize::try_from(inside(row) * SIDE + inside(column)).unwrap()]
}

/// Dots, bars, rims and a diagonal of ink on white paper, partly translucent.
const INK: &str = "vec4f(0.0, 0.0, 0.0, 1.0) * f32(
        (column == 5.0 && row == 5.0) || (column == 20.0 && row > 8.0 && row < 25.0)
        || (column == row && column > 24.0) || (row == 31.0 && column < 9.0))
    + vec4f(0.1, 0.2, 0.0, 0.5) * f32(column > 9.0 && column < 14.0 && row > 12.0)";

/// `INK`, and a pass's output for it.
fn of_ink(passes: &str) -> Texels {
    let folder = tempfile::tempdir().unwrap();
    of_pattern(folder.path(), INK, passes)
}

fn morphology(component: &str, shape: &str, count: u32) -> Texels {
    of_ink(&format!(
        "[[pass]]\ncomponent = \"{component}\"\ntexture = \"<generated>:pattern_color\"\n\
         pass_count = {count}\nshape = \"{shape}\"\nrender_target = \"out\"\n\
         render_target_format = \"rgba32f\""
    ))
}

/// The darkness of a premultiplied color on white paper.
fn darkness([red, green, blue, alpha]: [f32; 4]) -> f32 {
    alpha - (0.3 * red + 0.6 * green + 0.1 * blue)
}

/// One round of dilation or erosion, texel by texel.
fn morphed(texels: &Texels, shape: &str, sign: f32) -> Texels {
    let around = |column: i32, row: i32| {
        let mut extreme = at(texels, column, row);
        for (x, y) in (-1..=1).flat_map(|y| (-1..=1).map(move |x| (x, y))) {
            let other = at(texels, column + x, row + y);
            if (shape == "square" || x * y == 0)
                && sign * darkness(other) > sign * darkness(extreme)
            {
                extreme = other;
            }
        }
        extreme
    };
    (0..SIDE * SIDE).map(|index| around(index % SIDE, index / SIDE)).collect()
}

#[test]
fn dilation_and_erosion_are_repeated_extremes() {
    let ink = morphology("dilate", "square", 0);
    assert_eq!(at(&ink, 5, 5), [0.0, 0.0, 0.0, 1.0], "no round changes nothing");
    assert_eq!(at(&ink, 6, 5), [0.0; 4], "no round changes nothing");
    for shape in ["square", "cross"] {
        for (component, sign) in [("dilate", 1.0), ("erode", -1.0)] {
            let mut wanted = ink.clone();
            for count in 1..=3 {
                wanted = morphed(&wanted, shape, sign);
                let found = morphology(component, shape, count);
                assert_eq!(found, wanted, "{component}, {shape}, {count} rounds");
            }
        }
    }
    // A dot becomes a square, or a diamond, of its rounds.
    let dots = |texels: &Texels| {
        (0..10)
            .flat_map(|y| (0..9).map(move |x| (x, y)))
            .filter(|&(x, y)| at(texels, x, y)[3] > 0.0)
            .count()
    };
    assert_eq!(dots(&morphology("dilate", "square", 2)), 25);
    assert_eq!(dots(&morphology("dilate", "cross", 2)), 13);
    // Bars thinner than two texels per round vanish, a wide bar becomes thinner.
    let eroded = morphology("erode", "square", 1);
    assert_eq!(at(&eroded, 20, 15), [0.0; 4]);
    let bar = (9..15).filter(|&column| at(&eroded, column, 20)[3] > 0.0).count();
    assert_eq!(bar, 2);
}

const FLOOD: &str = "[[pass]]\ncomponent = \"flood_seeds\"\n\
    texture = \"<generated>:pattern_color\"\nrender_target = \"seeds\"\n\
    [[pass]]\ncomponent = \"flood\"\ntexture = \"<generated>:seeds_color\"\n";

/// The texels of `INK` that are dark enough for lines.
fn line_texels() -> Vec<(i32, i32)> {
    let ink = morphology("dilate", "square", 0);
    let texels = (0..SIDE * SIDE).map(|index| (index % SIDE, index / SIDE));
    texels.filter(|&(column, row)| darkness(at(&ink, column, row)) > 0.5).collect()
}

#[test]
fn flooding_finds_the_nearest_line() {
    let lines = line_texels();
    assert!(lines.len() > 30, "{} texels of lines", lines.len());
    let found =
        of_ink(&format!("{FLOOD}render_target = \"out\"\nrender_target_format = \"rgba32f\""));
    let mut farther = 0;
    for (column, row) in (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (column, row))) {
        let distance = |(x, y): (i32, i32)| (x - column).pow(2) + (y - row).pow(2);
        let nearest = lines.iter().copied().map(distance).min().unwrap();
        let [x, y, ..] = at(&found, column, row);
        let seed = lines
            .iter()
            .copied()
            .find(|&(a, b)| (f64::from(a), f64::from(b)) == (x.into(), y.into()));
        let seed = seed.unwrap_or_else(|| panic!("{column}, {row}: {x}, {y} is no line"));
        farther += i32::from(distance(seed) > nearest);
    }
    // Jump flooding misses the nearest seed at a few texels where cells meet.
    assert!(farther <= 3, "{farther} of 1024 texels have a line that is not the nearest");
}

#[test]
fn lines_have_the_width_that_is_asked_for() {
    let lines = line_texels();
    for width in [0.0_f32, 2.0, 5.0, 7.5] {
        let found = of_ink(&format!(
            "{FLOOD}render_target = \"near\"\n[[pass]]\ncomponent = \"wide_lines\"\n\
             texture = \"<generated>:near_color\"\nwidth = {width:.2}\nrender_target = \"out\"\n\
             render_target_format = \"rgba32f\"\nedge_color = \"#ffffff\"\n\
             background_color = \"#000000\""
        ));
        let mut wrong = 0;
        for (column, row) in (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (column, row))) {
            let distance = |(x, y): (i32, i32)| f64::from((x - column).pow(2) + (y - row).pow(2));
            let nearest = lines.iter().copied().map(distance).fold(f64::MAX, f64::min).sqrt();
            let wanted = (0.5 * f64::from(width) - nearest).clamp(0.0, 1.0);
            let strength = f64::from(at(&found, column, row)[0]);
            wrong += i32::from((strength - wanted).abs() > 1e-5);
        }
        assert!(wrong <= 3, "{width}: {wrong} of 1024 texels");
    }
}

/// Detected lines are on both sides of a boundary; the width is measured around it.
#[test]
fn lines_around_two_texels_cover_their_width() {
    let folder = tempfile::tempdir().unwrap();
    for width in [2.0_f32, 3.0, 6.0, 10.5] {
        let passes = format!(
            "{FLOOD}render_target = \"near\"\n[[pass]]\ncomponent = \"wide_lines\"\n\
             texture = \"<generated>:near_color\"\nwidth = {width:.2}\nrender_target = \"out\"\n\
             render_target_format = \"rgba32f\"\nedge_color = \"#ffffff\"\n\
             background_color = \"#000000\""
        );
        let pair = "vec4f(vec3f(select(1.0, 0.0, column == 15.0 || column == 16.0)), 1.0)";
        let found = of_pattern(folder.path(), pair, &passes);
        let covered: f32 = (0..SIDE).map(|column| at(&found, column, 16)[0]).sum();
        assert!((covered - width).abs() < 1e-5, "{covered} texels, not {width}");
    }
}

/// Without a line, no texel is near one.
#[test]
fn flooding_of_nothing_draws_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let passes = format!(
        "{FLOOD}render_target = \"near\"\n[[pass]]\ncomponent = \"wide_lines\"\n\
         texture = \"<generated>:near_color\"\nwidth = 20.0\nrender_target = \"out\"\n\
         render_target_format = \"rgba32f\"\nedge_color = \"#ffffff\"\n\
         background_color = \"#000000\""
    );
    let found = of_pattern(folder.path(), "vec4f(1.0)", &passes);
    assert!(found.iter().all(|texel| texel[0] == 0.0));
}

fn smoothed(pattern: &str) -> Texels {
    let folder = tempfile::tempdir().unwrap();
    let passes = "[[pass]]\ncomponent = \"antialias\"\ntexture = \"<generated>:pattern_color\"\n\
                  render_target = \"out\"\nrender_target_format = \"rgba32f\"";
    of_pattern(folder.path(), pattern, passes)
}

#[test]
fn smoothing_leaves_level_and_upright_rims_and_makes_slanted_ones_straight() {
    for pattern in ["vec4f(0.3)", "vec4f(vec3f(select(0.0, 1.0, column >= 16.0)), 1.0)"] {
        let found = smoothed(pattern);
        let is_bright = |column: i32| if pattern.contains("column") { column >= 16 } else { true };
        for index in 0..SIDE * SIDE {
            let texel = found[usize::try_from(index).unwrap()];
            let wanted = if pattern.contains("column") {
                f32::from(u8::from(is_bright(index % SIDE)))
            } else {
                0.3
            };
            assert!((texel[0] - wanted).abs() < 1e-6, "{pattern}: {index} is {texel:?}");
        }
    }
    // A rim that falls by a row in eight columns: in the middle of the picture, the white of
    // each column differs from that of the straight rim by at most an eighth of the error of
    // rounding to rows.
    let pattern = "vec4f(vec3f(select(0.0, 1.0, row >= 8.0 + floor(column / 8.0))), 1.0)";
    let found = smoothed(pattern);
    for column in 8..24 {
        let whites: f32 = (0..SIDE).map(|row| at(&found, column, row)[0]).sum();
        let rows = f64::from(SIDE) - 8.0 - (f64::from(column) + 0.5) / 8.0 + 0.5;
        let error = (f64::from(whites) - rows).abs();
        assert!(error < 0.5 / 8.0, "column {column}: {whites} rows are white, not {rows}");
    }
}
