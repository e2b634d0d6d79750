//! The results as one self-contained HTML page with tables, plots and pictures.

use std::fmt::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::Way;
use super::measure::Sums;

/// One row of the results.
#[derive(Debug, Clone)]
pub(crate) struct Row {
    /// Name of the model.
    pub(crate) model: String,
    /// Name of the camera path.
    pub(crate) path: &'static str,
    /// Name of the line class.
    pub(crate) class: &'static str,
    /// Name of the brush.
    pub(crate) brush: String,
    /// How the brush is mapped.
    pub(crate) way: Way,
    /// The measurements.
    pub(crate) sums: Sums,
    /// Milliseconds per frame, for all classes together.
    pub(crate) frame_ms: f64,
}

/// A picture of the page.
#[derive(Debug, Clone)]
pub(crate) struct Sheet {
    /// The caption.
    pub(crate) title: String,
    /// The PNG.
    pub(crate) png: Vec<u8>,
}

/// A measure: its name, its unit, and its value.
pub(crate) type Measure = (&'static str, &'static str, fn(&Row) -> f64);

/// All measures.
pub(crate) const MEASURES: [Measure; 7] = [
    ("breaks", "per 1000 px", |row| row.sums.breaks()),
    ("strokes", "per 1000 px", |row| row.sums.strokes()),
    ("stretch", "powers of two", |row| row.sums.stretch()),
    ("slide", "px per frame", |row| row.sums.slide()),
    ("pops", "of 1000 px", |row| row.sums.pops()),
    ("changed", "of 1000 px", |row| row.sums.changed()),
    ("cost", "ms per frame", |row| row.frame_ms),
];

/// The rows as comma-separated values.
#[must_use]
pub(crate) fn csv(rows: &[Row]) -> String {
    let mut text = String::from(
        "model,path,class,brush,parameterization,length_px,breaks_per_1000_px,strokes_per_1000_px,\
         stretch_log2,slide_px,pops_per_1000_px,changed_per_1000_px,frame_ms\n",
    );
    for row in rows {
        let model = row.model.replace(['"', '\n'], "'");
        let way = row.way.name();
        let _ = write!(text, "\"{model}\",{},{},{},{way}", row.path, row.class, row.brush);
        let _ = write!(text, ",{:.1}", row.sums.length_px);
        for (_, _, measure) in MEASURES {
            let _ = write!(text, ",{:.4}", measure(row));
        }
        text.push('\n');
    }
    text
}

/// The sums of all rows with `is_wanted`, for each way.
fn total(rows: &[Row], way: Way, is_wanted: impl Fn(&Row) -> bool) -> Option<Row> {
    let mut wanted = rows.iter().filter(|row| row.way == way && is_wanted(row));
    let mut sum = wanted.next()?.clone();
    let mut count = 1.0;
    for row in wanted {
        sum.sums.add(&row.sums);
        sum.frame_ms += row.frame_ms;
        count += 1.0;
    }
    sum.frame_ms /= count;
    Some(sum)
}

/// Names in the order of their first occurrence.
fn names(rows: &[Row], name: impl Fn(&Row) -> String) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for row in rows {
        let name = name(row);
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// The HTML page.
#[must_use]
pub(crate) fn html(adapter: &str, rows: &[Row], sheets: &[Sheet]) -> String {
    let mut page = String::from(HEAD);
    let _ = write!(page, "<p>Drawn on {}. {INTRODUCTION}</p>", escaped(adapter));
    page.push_str("<h2>All results</h2>");
    page.push_str(&table(rows, &[String::new()], |_, _| true));
    type Name = fn(&Row) -> String;
    let groups: [(&str, Name); 4] = [
        ("By model", |row| row.model.clone()),
        ("By camera path", |row| row.path.into()),
        ("By line class", |row| row.class.into()),
        ("By brush", |row| row.brush.clone()),
    ];
    for (title, name) in groups {
        let names = names(rows, name);
        let _ = write!(page, "<h2>{title}</h2>");
        page.push_str(&table(rows, &names, |row, wanted| name(row) == wanted));
        for (measure, unit, value) in MEASURES {
            page.push_str(&plot(rows, &names, name, (measure, unit, value)));
        }
    }
    page.push_str("<h2>Pictures</h2>");
    for sheet in sheets {
        let (title, data) = (escaped(&sheet.title), STANDARD.encode(&sheet.png));
        let _ = write!(
            page,
            "<figure><figcaption>{title}</figcaption>\
             <img alt=\"{title}\" src=\"data:image/png;base64,{data}\"></figure>"
        );
    }
    page.push_str("</body></html>\n");
    page
}

fn table(rows: &[Row], names: &[String], is_of: impl Fn(&Row, &str) -> bool) -> String {
    let mut text = String::from("<table><tr><th></th><th>parameterization</th>");
    for (measure, unit, _) in MEASURES {
        let _ = write!(text, "<th>{measure}<br><small>{unit}</small></th>");
    }
    text.push_str("</tr>");
    for name in names {
        for way in Way::ALL {
            let Some(row) = total(rows, way, |row| is_of(row, name)) else { continue };
            let _ = write!(text, "<tr><td>{}</td><td>{}</td>", escaped(name), way.name());
            for (_, _, measure) in MEASURES {
                let _ = write!(text, "<td class=number>{:.2}</td>", measure(&row));
            }
            text.push_str("</tr>");
        }
    }
    text.push_str("</table>");
    text
}

/// A bar chart: one group per name, one bar per way.
fn plot(
    rows: &[Row],
    names: &[String],
    name: fn(&Row) -> String,
    (measure, unit, value): Measure,
) -> String {
    let values: Vec<[f64; 3]> = names
        .iter()
        .map(|wanted| {
            Way::ALL.map(|way| {
                total(rows, way, |row| name(row) == *wanted).map_or(0.0, |row| value(&row))
            })
        })
        .collect();
    let most = values.iter().flatten().copied().fold(1e-9, f64::max);
    let mut svg = format!(
        "<svg viewBox=\"0 0 360 200\" role=img aria-label=\"{measure}\"><text x=4 y=14>{measure}, \
         {unit}</text>"
    );
    #[expect(clippy::cast_precision_loss, reason = "a handful of names")]
    let group = 350.0 / names.len().max(1) as f64;
    let mut left = 5.0;
    for (name, values) in names.iter().zip(&values) {
        for (bar, (value, color)) in
            values.iter().zip(["#c2571a", "#2a6f97", "#3a7d44"]).enumerate()
        {
            let height = 140.0 * value / most;
            #[expect(clippy::cast_precision_loss, reason = "three bars")]
            let x = left + group * 0.27 * bar as f64;
            let (width, y) = (group * 0.25, 170.0 - height);
            let _ = write!(
                svg,
                "<rect x={x:.1} y={y:.1} width={width:.1} height={height:.1} fill=\"{color}\">\
                 <title>{value:.3}</title></rect>"
            );
        }
        let short: String = name.chars().take(14).collect();
        let _ = write!(svg, "<text x={left:.1} y=186 class=name>{}</text>", escaped(&short));
        left += group;
    }
    svg.push_str("</svg>");
    svg
}

const HEAD: &str = "<!doctype html><html lang=en><meta charset=utf-8>\
<meta name=viewport content=\"width=device-width\"><title>Stroke textures compared</title><style>\
body{font:16px/1.5 system-ui,sans-serif;margin:2rem auto;max-width:72rem;padding:0 1rem;color:#222}\
table{border-collapse:collapse;margin:1rem 0}td,th{border-bottom:1px solid #ddd;padding:.2rem .7rem;\
text-align:left;font-weight:400}th{color:#555}.number{text-align:right;\
font-variant-numeric:tabular-nums}svg{width:22rem;margin:.5rem}svg text{font:12px system-ui}\
svg .name{font-size:10px}img{max-width:100%;border:1px solid #ddd}figure{margin:1.5rem 0}\
b{font-weight:600}</style><body><h1>Stroke textures compared</h1>";

const INTRODUCTION: &str = "The same lines with the brush mapped along them in three ways: \
<b style=\"color:#c2571a\">object-space</b> and <b style=\"color:#2a6f97\">screen-space</b> as in \
McGuire and Hughes, section 4, and <b style=\"color:#3a7d44\">chained</b>, by arc length along linked \
strokes. Breaks: places along lines where the brush jumps. Strokes: pieces without a break. Stretch: \
how much longer or shorter a repeat is than the brush. Slide: how far the brush moves over the \
surface from frame to frame. Pops: lines whose brush jumps from frame to frame. Changed: lines that \
were not in the frame before, the same in all three. Cost: a whole frame.";
