//! A limit for the loops of user shaders.
//!
//! Whether a program ends cannot be decided, and a program that does not end blocks the
//! graphics adapter: the window, the driver or the whole desktop can hang. So each
//! invocation of a user shader counts its loop iterations and leaves all further loops
//! after [`MAX_ITERATIONS`]. The picture is then wrong, which the user can see and fix.
//!
//! Rejected: stopping the adapter from outside, which no API supports.

use naga::{
    AddressSpace, BinaryOperator, Block, Expression, Function, GlobalVariable, Handle, Literal,
    Module, Range, Scalar, Span, Statement, Type, TypeInner,
};

/// Loop iterations of an invocation, all loops together: far more than effects need, and
/// few enough that the slowest adapter draws a picture that uses all of them in seconds.
pub(crate) const MAX_ITERATIONS: u32 = 1 << 14;

/// Adds the limit to all loops of a valid module.
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
    let iterations = GlobalVariable {
        name: Some("loop_iterations".into()),
        space: AddressSpace::Private,
        binding: None,
        ty: number,
        init: Some(zero),
        memory_decorations: naga::MemoryDecorations::empty(),
    };
    let iterations = module.global_variables.append(iterations, Span::UNDEFINED);
    for (_, function) in module.functions.iter_mut() {
        bound_function(function, iterations);
    }
    for entry in &mut module.entry_points {
        bound_function(&mut entry.function, iterations);
    }
}

fn bound_function(function: &mut Function, iterations: Handle<GlobalVariable>) {
    let mut body = std::mem::take(&mut function.body);
    bound_block(&mut body, function, iterations);
    function.body = body;
}

/// The blocks inside a statement.
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

fn bound_block(block: &mut Block, function: &mut Function, iterations: Handle<GlobalVariable>) {
    for statement in block.iter_mut() {
        for inner in blocks_of(statement) {
            bound_block(inner, function, iterations);
        }
        if let Statement::Loop { body, .. } = statement {
            let mut counted = counting(function, iterations);
            counted.append(body);
            *body = counted;
        }
    }
}

/// `iterations += 1; if iterations > MAX_ITERATIONS { break; }`
fn counting(function: &mut Function, iterations: Handle<GlobalVariable>) -> Block {
    let mut add = |expression| function.expressions.append(expression, Span::UNDEFINED);
    let pointer = add(Expression::GlobalVariable(iterations));
    let one = add(Expression::Literal(Literal::U32(1)));
    let most = add(Expression::Literal(Literal::U32(MAX_ITERATIONS)));
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
                *expression == Expression::Literal(Literal::U32(MAX_ITERATIONS))
            };
            function.expressions.iter().filter(|(_, expression)| is_count(expression)).count()
        };
        let nested = module.functions.iter().next().unwrap().1;
        assert_eq!((counted(nested), counted(&module.entry_points[0].function)), (2, 2));
    }

    #[test]
    fn a_module_without_loops_is_not_changed() {
        let source = "@fragment fn one() -> @location(0) vec4f { return vec4f(1.0); }";
        let module = naga::front::wgsl::parse_str(source).unwrap();
        let mut bound = module.clone();
        bound_loops(&mut bound);
        assert_eq!(bound.global_variables.len(), module.global_variables.len());
    }
}
