//! Variables against the fields of a program's `Params`.

use super::descriptor::VariableDescriptor;
use super::mistake::{Mistake, Mistakes};
use super::pass::Pass;
use super::program::{Field, FieldKind, Program};
use super::value::VariableType;

/// Fields that the runner fills in by itself, in programs that are run again and again.
pub(crate) const OWN_FIELDS: [&str; 2] = ["iteration", "iteration_count"];

/// Checks both programs of a pass: each field is a variable that is bound to it, of its
/// type, and each variable that is to be bound has its field.
pub(crate) fn check(
    pass: &Pass,
    vertex: Option<&Program>,
    fragment: Option<&Program>,
    mistakes: &mut Mistakes,
) {
    for program in [vertex, fragment].into_iter().flatten() {
        check_used(pass, program, mistakes);
    }
    for (_, variable) in pass.component.parameters() {
        let wanted = [
            (variable.vertex_parameter, vertex, "vertex_program"),
            (variable.fragment_parameter, fragment, "fragment_program"),
        ];
        for (is_wanted, program, which) in wanted {
            // Components without such a program ignore it.
            let Some(program) = program.filter(|_| is_wanted) else { continue };
            let params = program.interface.params.as_ref();
            let fields = params.map_or(&[][..], |params| &params.fields);
            if fields.iter().all(|field| field.name != variable.name) {
                let message = format!(
                    "the program {} has no field '{}' in its Params",
                    pass.string(which),
                    variable.name
                );
                let names: Vec<&str> = fields.iter().map(|field| field.name.as_str()).collect();
                let mut mistake = Mistake::error(pass.place_of(which), message);
                mistake = mistake.also(&variable.place, "this variable is to be bound to it");
                if let Some(params) = params {
                    mistake = mistake.also(&params.place, "these are its parameters");
                }
                mistakes.add(mistake.names(&variable.name, names));
            }
        }
    }
}

/// Checks that each field of a program is a variable of its type.
pub(crate) fn check_used(pass: &Pass, program: &Program, mistakes: &mut Mistakes) {
    let Some(params) = &program.interface.params else { return };
    for field in &params.fields {
        if OWN_FIELDS.contains(&field.name.as_str()) {
            continue;
        }
        let Some((_, variable)) = pass.component.variable(&field.name) else {
            let component = &pass.component.name;
            let message =
                format!("the field '{}' of Params is no variable of {component}", field.name);
            let names: Vec<&str> = pass.component.variable_names().collect();
            mistakes.add(Mistake::error(&field.place, message).names(&field.name, names));
            continue;
        };
        if !fits(variable, field) {
            let message = format!(
                "the field '{}' is {}, and the variable a {}",
                field.name,
                field.type_name,
                variable.kind.name()
            );
            let note = format!("make the field {}", wanted(variable));
            let mistake = Mistake::error(&field.place, message).also(&variable.place, "here");
            mistakes.add(mistake.note(note));
        }
    }
}

fn fits(variable: &VariableDescriptor, field: &Field) -> bool {
    match variable.kind {
        VariableType::Bool | VariableType::Int => {
            field.count == 1 && field.kind != FieldKind::Float
        }
        VariableType::String => !variable.one_of.is_empty() && field.type_name == "u32",
        VariableType::Texture => false,
        kind => field.kind == FieldKind::Float && field.count == kind.number_count(),
    }
}

/// The WGSL type for a variable.
fn wanted(variable: &VariableDescriptor) -> String {
    match variable.kind {
        VariableType::Bool => "u32: 0 or 1".to_owned(),
        VariableType::Int => "i32".to_owned(),
        VariableType::Number => "f32".to_owned(),
        VariableType::String if variable.one_of.is_empty() => {
            "another one: a text has no number unless its words are listed (one_of)".to_owned()
        }
        VariableType::String => "u32: the number of the word".to_owned(),
        VariableType::Texture => "a global of the type texture_2d<f32>".to_owned(),
        kind => format!("vec{}f", kind.number_count()),
    }
}
