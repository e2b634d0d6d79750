//! Loops that end, whatever a shader says.
//!
//! WGSL cannot be asked whether a program ends, and one that does not takes the graphics
//! adapter with it: a window stands still, a driver gives up, a whole desktop can hang.
//! So the loops of shaders that are not our own are counted: each invocation has so many
//! turns through loops in all, and leaves the next loop when they are used up. The picture
//! is then wrong, which can be seen and mended.
//!
//! Rejected: stopping the adapter from outside, which no API can.

use naga::{
    AddressSpace, BinaryOperator, Block, Expression, Function, GlobalVariable, Handle, Literal,
    Module, Range, Scalar, Span, Statement, Type, TypeInner,
};

/// The turns that an invocation has: far more than any effect needs, and few enough that
/// a picture that uses all of them is drawn in seconds on the slowest adapter.
pub const MOST_TURNS: u32 = 1 << 14;

/// Counts the turns of all loops of a valid module.
pub(crate) fn bound_loops(module: &mut Module) {
    let has_loops = module
        .functions
        .iter()
        .map(|(_, function)| function)
        .chain(module.entry_points.iter().map(|entry| &entry.function))
        .any(|function| has_loop(&function.body));
    if !has_loops {
        return;
    }
    let number = Type { name: None, inner: TypeInner::Scalar(Scalar::U32) };
    let number = module.types.insert(number, Span::UNDEFINED);
    let zero =
        module.global_expressions.append(Expression::Literal(Literal::U32(0)), Span::UNDEFINED);
    let turns = GlobalVariable {
        name: Some("turns_through_loops".into()),
        space: AddressSpace::Private,
        binding: None,
        ty: number,
        init: Some(zero),
        memory_decorations: naga::MemoryDecorations::empty(),
    };
    let turns = module.global_variables.append(turns, Span::UNDEFINED);
    for (_, function) in module.functions.iter_mut() {
        bound_function(function, turns);
    }
    for entry in &mut module.entry_points {
        bound_function(&mut entry.function, turns);
    }
}

fn bound_function(function: &mut Function, turns: Handle<GlobalVariable>) {
    let mut body = std::mem::take(&mut function.body);
    bound_block(&mut body, function, turns);
    function.body = body;
}

/// The blocks within a statement.
fn blocks_of(statement: &mut Statement) -> Vec<&mut Block> {
    match statement {
        Statement::Block(block) => vec![block],
        Statement::If { accept, reject, .. } => vec![accept, reject],
        Statement::Switch { cases, .. } => cases.iter_mut().map(|case| &mut case.body).collect(),
        Statement::Loop { body, continuing, .. } => vec![body, continuing],
        _ => Vec::new(),
    }
}

fn has_loop(block: &Block) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Loop { .. } => true,
        Statement::Block(block) => has_loop(block),
        Statement::If { accept, reject, .. } => has_loop(accept) || has_loop(reject),
        Statement::Switch { cases, .. } => cases.iter().any(|case| has_loop(&case.body)),
        _ => false,
    })
}

fn bound_block(block: &mut Block, function: &mut Function, turns: Handle<GlobalVariable>) {
    for statement in block.iter_mut() {
        for inner in blocks_of(statement) {
            bound_block(inner, function, turns);
        }
        if let Statement::Loop { body, .. } = statement {
            let mut counted = counting(function, turns);
            counted.append(body);
            *body = counted;
        }
    }
}

/// `turns += 1; if turns > MOST_TURNS { break; }`
fn counting(function: &mut Function, turns: Handle<GlobalVariable>) -> Block {
    let mut add = |expression| function.expressions.append(expression, Span::UNDEFINED);
    let pointer = add(Expression::GlobalVariable(turns));
    let one = add(Expression::Literal(Literal::U32(1)));
    let most = add(Expression::Literal(Literal::U32(MOST_TURNS)));
    let known = add(Expression::Load { pointer });
    let next = add(Expression::Binary { op: BinaryOperator::Add, left: known, right: one });
    let op = BinaryOperator::Greater;
    let is_over = add(Expression::Binary { op, left: next, right: most });
    let accept = Block::from_vec(vec![Statement::Break]);
    Block::from_vec(vec![
        Statement::Emit(Range::new_from_bounds(known, is_over)),
        Statement::Store { pointer, value: next },
        Statement::If { condition: is_over, accept, reject: Block::new() },
    ])
}

#[cfg(test)]
mod tests {
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    use super::*;

    #[test]
    fn loops_of_every_kind_are_counted_and_the_module_stays_valid() {
        let source = "
            fn nested(most: i32) -> i32 {
                var sum = 0;
                for (var i = 0; i < most; i++) { while sum < 9 { sum += i; } }
                return sum;
            }
            @fragment fn ends_not() -> @location(0) vec4f {
                var x = 1.0;
                switch nested(3) {
                    case 1: { loop { x *= 0.5; } }
                    default: { loop { x += 1.0; continuing { break if x > 9.0; } } }
                }
                return vec4f(x);
            }";
        let mut module = naga::front::wgsl::parse_str(source).unwrap();
        bound_loops(&mut module);
        let mut validator = Validator::new(ValidationFlags::all(), Capabilities::default());
        validator.validate(&module).unwrap();
        let counted = |function: &Function| {
            let is_count = |expression: &Expression| {
                *expression == Expression::Literal(Literal::U32(MOST_TURNS))
            };
            function.expressions.iter().filter(|(_, expression)| is_count(expression)).count()
        };
        let nested = module.functions.iter().next().unwrap().1;
        assert_eq!((counted(nested), counted(&module.entry_points[0].function)), (2, 2));
    }

    #[test]
    fn what_has_no_loops_stays_as_it_is() {
        let source = "@fragment fn one() -> @location(0) vec4f { return vec4f(1.0); }";
        let module = naga::front::wgsl::parse_str(source).unwrap();
        let mut bound = module.clone();
        bound_loops(&mut bound);
        assert_eq!(bound.global_variables.len(), module.global_variables.len());
    }
}
