//! A technique as text: what each pass reads, writes and sets, and the textures between
//! passes.

use std::fmt::Write as _;

use super::Technique;
use super::pass::Pass;
use super::plan::{PassPlan, Plan, ReadSource, Target};

/// The passes and textures of a technique, for `viewer techniques print`.
#[must_use]
pub(crate) fn technique_text(technique: &Technique, plan: &Plan) -> String {
    let mut text = format!("{}: {}\n", technique.name, technique.about);
    for (at, (pass, pass_plan)) in technique.passes.iter().zip(&plan.passes).enumerate() {
        text += "\n";
        text += &pass_text(at + 1, pass, pass_plan, plan);
    }
    if !plan.textures.is_empty() {
        text += "\ntextures\n";
    }
    for texture in &plan.textures {
        let format = texture.format.word();
        let _ = writeln!(text, "    <generated>:{}  {}, {format}", texture.name, texture.size);
    }
    text
}

fn pass_text(number: usize, pass: &Pass, pass_plan: &PassPlan, plan: &Plan) -> String {
    let component = &pass.component;
    let mut text = format!("{number} {} ({})", pass.name, component.name);
    if component.name != component.core.name() {
        let _ = write!(text, ", by {}", component.core.name());
    }
    if !pass.is_rendered() {
        text += ", switched off";
    }
    text.push('\n');
    for read in &pass_plan.reads {
        let source = match &read.source {
            ReadSource::None => continue,
            ReadSource::Generated(texture) => {
                format!("<generated>:{}", plan.textures[*texture].name)
            }
            ReadSource::Image(image) => image.name(),
        };
        let how = if read.is_filtered { "filtered" } else { "nearest" };
        let _ = writeln!(text, "    reads {source} as {}, {how}", read.variable);
    }
    match &pass_plan.target {
        Target::Framebuffer => text += "    draws to the picture\n",
        Target::Textures { .. } => {
            let names = pass_plan.target.textures().into_iter();
            let names: Vec<String> =
                names.map(|at| format!("<generated>:{}", plan.textures[at].name)).collect();
            let place = if pass_plan.is_in_place { ", in place" } else { "" };
            let _ = writeln!(text, "    draws to {}{place}", names.join(", "));
        }
    }
    for (variable, value) in component.variables.iter().zip(pass.values()) {
        let is_default = variable.default.as_ref() == Some(value);
        if !is_default || !variable.internal {
            let mark = if is_default { "" } else { " *" };
            let _ = writeln!(text, "    {} = {value}{mark}", variable.name);
        }
    }
    text
}
