//! The values of variables as the bytes of a program's `Params`.

use crate::technique::pass::Pass;
use crate::technique::program::{Field, FieldKind, Params};
use crate::technique::value::Value;

/// The index of a run of `ping_pong`, and the number of its runs.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Iteration {
    pub(crate) index: i32,
    pub(crate) count: i32,
}

/// The bytes of `params` with the values of `pass`, padded to a multiple of 16 for a
/// uniform buffer.
pub(crate) fn bytes_of(params: &Params, pass: &Pass, iteration: Iteration) -> Vec<u8> {
    let mut bytes = vec![0; (params.size as usize).next_multiple_of(16)];
    for field in &params.fields {
        let words = match field.name.as_str() {
            "iteration" => vec![iteration.index.to_le_bytes()],
            "iteration_count" => vec![iteration.count.to_le_bytes()],
            name => words_of(field, pass, name),
        };
        let start = field.offset as usize;
        for (at, word) in words.iter().enumerate().take(field.count) {
            let at = start + 4 * at;
            if let Some(slot) = bytes.get_mut(at..at + 4) {
                slot.copy_from_slice(word);
            }
        }
    }
    bytes
}

fn words_of(field: &Field, pass: &Pass, name: &str) -> Vec<[u8; 4]> {
    let Some((index, variable)) = pass.component.variable(name) else { return Vec::new() };
    match &pass.values()[index] {
        Value::Bool(value) => vec![u32::from(*value).to_le_bytes()],
        Value::Int(value) => vec![value.to_le_bytes()],
        Value::Numbers(numbers) if field.kind == FieldKind::Float => {
            numbers.iter().map(|number| number.to_le_bytes()).collect()
        }
        Value::String(word) => {
            let index = variable.word_index(word).unwrap_or_default();
            vec![edgemesh::index::to_u32(index).to_le_bytes()]
        }
        Value::Numbers(_) | Value::Texture(_) => Vec::new(),
    }
}
