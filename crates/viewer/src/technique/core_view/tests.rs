//! The views against the descriptors of the core components.

use super::reader::LogEntry;
use super::render_target::TEXTURE;
use super::strokes::MIN_WIDTH_PX;
use super::*;
use crate::technique::Technique;
use crate::technique::descriptor::SharedDescriptor;
use crate::technique::library::Library;
use crate::technique::mistake::Severity;
use crate::technique::pass::Assignment;
use crate::technique::plan::Plan;
use crate::technique::program::ShaderFiles;
use crate::technique::texture_name::TextureName;
use crate::technique::value::{Value, VariableType};
use crate::technique::word::Word as _;

/// Variables that no view reads.
const UNREAD: [(Option<CoreComponent>, &str, &str); 6] = [
    (None, "render", "Pass::is_rendered reads it"),
    (None, RunMode::VARIABLE, "RunMode::read reads it"),
    (Some(CoreComponent::SimpleRender), TEXTURE, "bound by reflection"),
    (Some(CoreComponent::PingPong), TEXTURE, "bound by reflection"),
    (Some(CoreComponent::Composite), TEXTURE, "bound by reflection"),
    (Some(CoreComponent::Composite), "opacity", "bound by reflection"),
];

fn descriptor(core: CoreComponent) -> SharedDescriptor {
    Library::shipped().components()[core.name()].clone()
}

/// A pass with defaults, and placeholders for variables without one.
fn pass(descriptor: &SharedDescriptor) -> Pass {
    let variables = descriptor.variables.iter().enumerate();
    let assignments = variables.filter(|(_, variable)| variable.default.is_none());
    let assignments = assignments.map(|(index, variable)| {
        let value = match variable.kind {
            VariableType::Texture => Value::Texture(TextureName::NONE),
            _ => Value::String("x".to_owned()),
        };
        Assignment { index, value, place: None }
    });
    let (assignments, place) = (assignments.collect(), descriptor.place.clone());
    Pass::new("p".to_owned(), descriptor.clone(), place, assignments, &mut Mistakes::default())
        .unwrap()
}

/// What the view of a pass reads.
fn log(pass: &Pass) -> Vec<LogEntry> {
    let mut mistakes = Mistakes::default();
    let mut reader = Reader::new(pass, &mut mistakes);
    let _ = CoreView::read_from(pass.component.core, &mut reader);
    let log = reader.log;
    assert_eq!(mistakes, Mistakes::default(), "{}", pass.component.name);
    log
}

#[test]
fn views_read_every_variable_with_its_type() {
    for core in CoreComponent::ALL {
        let descriptor = descriptor(core);
        let log = log(&pass(&descriptor));
        for variable in &descriptor.variables {
            let reads: Vec<VariableType> = log
                .iter()
                .filter(|entry| entry.name == variable.name)
                .map(|entry| entry.kind)
                .collect();
            let is_unread = UNREAD.iter().any(|(of, name, _)| {
                *name == variable.name && of.is_none_or(|exception| exception == core)
            });
            let wanted = if is_unread { vec![] } else { vec![variable.kind] };
            assert_eq!(reads, wanted, "{}.{}", core.name(), variable.name);
        }
        let is_known = |entry: &&LogEntry| descriptor.variable(entry.name).is_none();
        assert_eq!(log.iter().find(is_known), None, "{}", core.name());
    }
}

#[test]
fn views_have_every_word_of_the_descriptors() {
    for core in CoreComponent::ALL {
        let descriptor = descriptor(core);
        for entry in log(&pass(&descriptor)) {
            let (index, variable) = descriptor.variable(entry.name).unwrap();
            assert_eq!(entry.words, variable.one_of, "{}.{}", core.name(), entry.name);
            for word in &variable.one_of {
                let mut pass = pass(&descriptor);
                let value = Value::String(word.clone());
                pass.set_value(index, value, None, &mut Mistakes::default());
                log(&pass);
            }
        }
    }
}

#[test]
fn run_modes_are_the_words_of_the_variable() {
    let descriptor = descriptor(CoreComponent::GenerateTexture);
    let (index, variable) = descriptor.variable(RunMode::VARIABLE).unwrap();
    for word in &variable.one_of {
        let mut pass = pass(&descriptor);
        let mut mistakes = Mistakes::default();
        pass.set_value(index, Value::String(word.clone()), None, &mut mistakes);
        let mode = RunMode::read(&pass, &mut mistakes);
        assert_eq!((mode.word(), mistakes), (word.as_str(), Mistakes::default()));
    }
}

#[test]
fn a_variable_that_is_not_described_is_a_mistake() {
    let pass = pass(&descriptor(CoreComponent::CopyToTexture));
    let mut mistakes = Mistakes::default();
    let mut reader = Reader::new(&pass, &mut mistakes);
    assert!(!reader.bool("dept"));
    assert!(reader.string("depth").is_empty(), "of another type");
    let messages: Vec<&str> = mistakes.list.iter().map(|m| m.message.as_str()).collect();
    let wanted = [
        "copy_to_texture has no variable 'dept' of type bool",
        "copy_to_texture has no variable 'depth' of type string",
    ];
    assert_eq!(messages, wanted);
}

/// A technique of a user with a component that allows what its core component does not.
fn technique(modify: &str) -> Technique {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let text = format!(
        "[component.mine]\ninherits = \"strokes\"\n[component.mine.modify]\n{modify}\n\
         [[pass]]\ncomponent = \"mine\"\n"
    );
    std::fs::write(&path, text).unwrap();
    Library::shipped().technique_file(&path).unwrap_or_else(|mistakes| panic!("{mistakes}")).0
}

#[test]
fn values_that_a_core_component_does_not_have_are_mistakes() {
    for (modify, message) in [
        (
            "join = { one_of = [\"round\", \"bevel\"], default = \"bevel\" }",
            "'bevel' is not a value of 'join'",
        ),
        ("seed = { minimum = -9, default = -3 }", "seed = -3 is out of range"),
        ("classes = { default = \"ridge, rim\" }", "unknown class 'rim'"),
    ] {
        let technique = technique(modify);
        let mistakes = Plan::of(&technique, &ShaderFiles::default()).unwrap_err();
        assert_eq!(mistakes.list.len(), 1, "{mistakes}");
        assert_eq!(mistakes.list[0].message, message);
        assert!(Strokes::of(&technique.passes[0]).is_err(), "{message}");
    }
}

#[test]
fn the_least_width_in_pixels_is_used_with_a_warning() {
    let view = |settings: &[&str]| {
        let mut technique = Library::shipped().technique("ink").unwrap().0;
        for setting in settings {
            technique.set(setting).unwrap();
        }
        let plan = Plan::of(&technique, &ShaderFiles::default()).unwrap();
        (Strokes::of(technique.pass("strokes").unwrap()).unwrap().width, plan.warnings)
    };
    assert_eq!(view(&["strokes.width=0.1"]), (StrokeWidth::Pixels(0.1), Mistakes::default()));
    let (width, warnings) = view(&["strokes.width=0.05"]);
    assert_eq!((width, warnings.list.len()), (StrokeWidth::Pixels(MIN_WIDTH_PX), 1));
    assert_eq!(warnings.list[0].severity, Severity::Warning);
    assert_eq!(warnings.list[0].message, "width = 0.05 is out of range; 0.1 is used");
    let model = view(&["strokes.width=0.05", "strokes.width_unit=model"]);
    assert_eq!(model, (StrokeWidth::Model(0.05), Mistakes::default()));
}
