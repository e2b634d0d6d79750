//! Compares the variables of a pass with the fields of a program's `Params`.

use super::core_view::programs;
use super::descriptor::VariableDescriptor;
use super::mistake::{Mistake, Mistakes};
use super::pass::Pass;
use super::program::{Field, FieldKind, PassPrograms, Program};
use super::value::VariableType;

/// Fields without a variable: the number of a run and the number of runs of `ping_pong`.
pub(crate) const ITERATION_FIELDS: [&str; 2] = ["iteration", "iteration_count"];

/// Checks the programs of a pass: each field must have a variable of its type, and each
/// variable that is a parameter must have a field.
pub(crate) fn check(pass: &Pass, programs: &PassPrograms, mistakes: &mut Mistakes) {
    let PassPrograms { vertex, fragment, background } = programs;
    for program in [vertex, fragment, background].into_iter().flatten() {
        check_fields(pass, program, mistakes);
    }
    for (_, variable) in pass.component.parameters() {
        let bindings = [
            (variable.vertex_parameter, vertex, programs::VERTEX),
            (variable.fragment_parameter, fragment, programs::FRAGMENT),
        ];
        for (is_bound, program, program_variable) in bindings {
            // Components without such a program ignore the flag.
            if let Some(program) = program.as_ref().filter(|_| is_bound) {
                check_bound(pass, variable, program, program_variable, mistakes);
            }
        }
    }
}

/// Checks that a program has a field for a variable.
fn check_bound(
    pass: &Pass,
    variable: &VariableDescriptor,
    program: &Program,
    program_variable: &str,
    mistakes: &mut Mistakes,
) {
    let params = program.interface.params.as_ref();
    let fields = params.map_or(&[][..], |params| &params.fields);
    if fields.iter().any(|field| field.name == variable.name) {
        return;
    }
    let message =
        format!("the program {} has no field '{}' in its Params", program.name, variable.name);
    let names: Vec<&str> = fields.iter().map(|field| field.name.as_str()).collect();
    let mut mistake = Mistake::error(pass.place_of(program_variable), message);
    mistake = mistake.also(&variable.place, "the variable");
    if let Some(params) = params {
        mistake = mistake.also(&params.place, "the parameters of the program");
    }
    mistakes.add(mistake.names(&variable.name, names));
}

/// Checks that each field of a program is a variable of its type.
fn check_fields(pass: &Pass, program: &Program, mistakes: &mut Mistakes) {
    let Some(params) = &program.interface.params else { return };
    for field in &params.fields {
        if ITERATION_FIELDS.contains(&field.name.as_str()) {
            continue;
        }
        let Some((_, variable)) = pass.component.variable(&field.name) else {
            let component = &pass.component.name;
            let message =
                format!("the field '{}' of Params is not a variable of {component}", field.name);
            let names: Vec<&str> = pass.component.variable_names().collect();
            mistakes.add(Mistake::error(&field.place, message).names(&field.name, names));
            continue;
        };
        if !fits(variable, field) {
            let message = format!(
                "the field '{}' has the type {}, but its variable has the type {}",
                field.name,
                field.type_name,
                variable.kind.name()
            );
            let mistake =
                Mistake::error(&field.place, message).also(&variable.place, "the variable");
            mistakes.add(mistake.note(hint(variable)));
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

/// How to make a field fit a variable.
fn hint(variable: &VariableDescriptor) -> String {
    let type_name = match variable.kind {
        VariableType::Bool => "u32: 0 or 1",
        VariableType::Int => "i32",
        VariableType::Number => "f32",
        VariableType::String if variable.one_of.is_empty() => {
            return "a string without one_of cannot be a parameter".to_owned();
        }
        VariableType::String => "u32: the index of the word in one_of",
        VariableType::Texture => {
            return "declare a texture as a global variable of the type texture_2d<f32>".to_owned();
        }
        VariableType::Vector2 => "vec2f",
        VariableType::Vector3 | VariableType::Rgb => "vec3f",
        VariableType::Vector4 | VariableType::Rgba => "vec4f",
    };
    format!("make the field {type_name}")
}
