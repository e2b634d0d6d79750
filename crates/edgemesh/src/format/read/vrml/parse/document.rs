//! A file as a tree of nodes, stored in lists instead of pointers.
//!
//! ```text
//! nodes   Group -> Shape -> ...        each has its first child and next sibling
//! fields  (name, numbers a..b, words c..d, first node)   consecutive for each node
//! numbers 0 0 0 1 0 0 ...              one list for the file, and one of their lines
//! ```
//!
//! This holds both versions: in VRML 1.0 children are between the fields of a node, in
//! VRML 97 they are nodes of a field. A `USE` is a node with a target, which is always
//! complete and before it. So there are no cycles.
//!
//! Rejected: a tree of boxes, because dropping 100,000 nested groups overflows the stack.

use std::collections::HashSet;
use std::ops::Range;
use std::rc::Rc;

use super::origin::Origin;
use super::version::Version;
use crate::index::NONE;

/// The index of a node in a [`Document`].
pub(crate) type NodeId = u32;

/// The index of a name or string in a [`Document`].
pub(crate) type Symbol = u32;

/// A parsed file.
#[derive(Debug)]
pub(crate) struct Document {
    /// The file.
    pub(crate) origin: Origin,
    /// Its version.
    pub(crate) version: Version,
    /// The nodes; the first is the root, which stands for the file.
    pub(crate) nodes: Vec<Node>,
    /// The fields, consecutive for each node.
    pub(crate) fields: Vec<Field>,
    /// The numbers, consecutive for each field.
    pub(crate) numbers: Vec<f64>,
    /// The lines of the numbers: the index of the first number of a line, and the line.
    pub(crate) number_lines: Vec<[u32; 2]>,
    /// The strings and bare words, consecutive for each field.
    pub(crate) words: Vec<Symbol>,
    /// The names and strings, each once.
    pub(crate) symbols: Vec<Rc<str>>,
    /// The node types that a `PROTO` or `EXTERNPROTO` defines.
    pub(crate) prototypes: HashSet<Symbol>,
}

/// A node, or a `USE` of a node.
#[derive(Debug)]
pub(crate) struct Node {
    /// Its type.
    pub(crate) kind: Symbol,
    /// Its `DEF` name, or [`NONE`].
    pub(crate) name: Symbol,
    /// The target of a `USE`, or [`NONE`].
    pub(crate) target: NodeId,
    /// The line of its type.
    pub(crate) line: u32,
    /// Its first child, or [`NONE`].
    pub(crate) first_child: NodeId,
    /// The next node of its list, or [`NONE`].
    pub(crate) next: NodeId,
    /// The range of its fields.
    pub(crate) fields: [u32; 2],
}

/// A field of a node, with its values by kind.
#[derive(Debug)]
pub(crate) struct Field {
    /// Its name.
    pub(crate) name: Symbol,
    /// Its line.
    pub(crate) line: u32,
    /// The range of its numbers.
    pub(crate) numbers: [u32; 2],
    /// The range of its words.
    pub(crate) words: [u32; 2],
    /// Its first node, or [`NONE`].
    pub(crate) first_node: NodeId,
}

impl Document {
    /// The root, which stands for the file.
    pub(crate) const fn root(&self) -> NodeRef<'_> {
        NodeRef { document: self, id: 0 }
    }

    /// The number of nodes, fields, numbers and words.
    pub(crate) const fn element_count(&self) -> usize {
        self.nodes.len() + self.fields.len() + self.numbers.len() + self.words.len()
    }

    fn symbol(&self, symbol: Symbol) -> &Rc<str> {
        &self.symbols[symbol as usize]
    }

    fn node(&self, id: NodeId) -> Option<NodeRef<'_>> {
        (id != NONE).then_some(NodeRef { document: self, id })
    }
}

const fn as_range([start, end]: [u32; 2]) -> Range<usize> {
    start as usize..end as usize
}

/// Identifies a node: the address of its document, and its index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct NodeKey {
    document: usize,
    node: NodeId,
}

/// A node of a document.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NodeRef<'a> {
    /// The document.
    pub(crate) document: &'a Document,
    /// The node in it.
    id: NodeId,
}

impl<'a> NodeRef<'a> {
    fn node(self) -> &'a Node {
        &self.document.nodes[self.id as usize]
    }

    /// The target of a `USE`, or the node itself.
    pub(crate) fn target(self) -> Self {
        self.document.node(self.node().target).unwrap_or(self)
    }

    /// Identifies the node among those of all documents.
    pub(crate) fn key(self) -> NodeKey {
        NodeKey { document: std::ptr::from_ref(self.document).addr(), node: self.id }
    }

    /// Its type.
    pub(crate) fn kind(self) -> &'a str {
        self.document.symbol(self.node().kind)
    }

    /// Its `DEF` name.
    pub(crate) fn name(self) -> Option<&'a Rc<str>> {
        Some(self.node().name).filter(|&name| name != NONE).map(|name| self.document.symbol(name))
    }

    /// The line of its type.
    pub(crate) fn line(self) -> u32 {
        self.node().line
    }

    /// Whether its type is defined in the file.
    pub(crate) fn is_prototype(self) -> bool {
        self.document.prototypes.contains(&self.node().kind)
    }

    /// Its first child.
    pub(crate) fn first_child(self) -> Option<Self> {
        self.document.node(self.node().first_child)
    }

    /// The next node of its list.
    pub(crate) fn next(self) -> Option<Self> {
        self.document.node(self.node().next)
    }

    /// Its fields in the order of the file.
    pub(crate) fn fields(self) -> impl DoubleEndedIterator<Item = FieldRef<'a>> {
        let document = self.document;
        let fields = &document.fields[as_range(self.node().fields)];
        fields.iter().map(move |field| FieldRef { document, field })
    }

    /// The number of its fields.
    pub(crate) fn field_count(self) -> usize {
        as_range(self.node().fields).len()
    }

    /// The field with this name; the last of several.
    pub(crate) fn field(self, name: &str) -> Option<FieldRef<'a>> {
        self.fields().rfind(|field| field.name() == name)
    }

    /// The node of a field, or the target of its `USE`.
    pub(crate) fn node_of(self, field: &str) -> Option<Self> {
        self.field(field)?.first_node().map(Self::target)
    }

    /// The numbers of a field; empty if it is missing.
    pub(crate) fn numbers(self, field: &str) -> Numbers<'a> {
        self.field(field).map_or_else(Numbers::default, FieldRef::numbers)
    }

    /// The first number of a field, or `default`.
    pub(crate) fn number(self, field: &str, default: f64) -> f64 {
        self.numbers(field).values.first().copied().unwrap_or(default)
    }

    /// The first `N` numbers of a field, or `default`.
    pub(crate) fn vector<const N: usize>(self, field: &str, default: [f64; N]) -> [f64; N] {
        self.numbers(field).values.first_chunk().copied().unwrap_or(default)
    }

    /// The strings and bare words of a field.
    pub(crate) fn words(self, field: &str) -> impl Iterator<Item = &'a str> {
        let document = self.document;
        let range = self.field(field).map_or(0..0, |field| as_range(field.field.words));
        document.words[range].iter().map(|&word| &**document.symbol(word))
    }

    /// The first word of a field.
    pub(crate) fn word(self, field: &str) -> Option<&'a str> {
        self.words(field).next()
    }

    /// Whether a field is `TRUE`, or `default`.
    pub(crate) fn flag(self, field: &str, default: bool) -> bool {
        self.word(field).map_or(default, |word| word == "TRUE")
    }
}

/// A field of a node.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FieldRef<'a> {
    document: &'a Document,
    field: &'a Field,
}

impl<'a> FieldRef<'a> {
    /// Its name.
    pub(crate) fn name(self) -> &'a str {
        self.document.symbol(self.field.name)
    }

    /// Its numbers.
    pub(crate) fn numbers(self) -> Numbers<'a> {
        Numbers {
            values: &self.document.numbers[as_range(self.field.numbers)],
            first: self.field.numbers[0],
            lines: &self.document.number_lines,
            line: self.field.line,
        }
    }

    /// Its first node, which may be a `USE`.
    pub(crate) fn first_node(self) -> Option<NodeRef<'a>> {
        self.document.node(self.field.first_node)
    }
}

/// Consecutive numbers, with their lines.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Numbers<'a> {
    /// The numbers.
    pub(crate) values: &'a [f64],
    /// The index of the first number in the file.
    first: u32,
    /// [`Document::number_lines`]; empty for generated numbers.
    lines: &'a [[u32; 2]],
    /// The line of numbers that are not in `lines`.
    line: u32,
}

impl<'a> Numbers<'a> {
    /// Numbers that are generated for a node in `line`.
    pub(crate) const fn generated(values: &'a [f64], line: u32) -> Self {
        Self { values, first: 0, lines: &[], line }
    }

    /// The line of a number.
    pub(crate) fn line_of(&self, at: usize) -> u32 {
        let number = self.first as usize + at;
        let later = self.lines.partition_point(|&[first, _]| first as usize <= number);
        match later.checked_sub(1).and_then(|last| self.lines.get(last)) {
            Some(&[_, line]) => line,
            None => self.line,
        }
    }

    /// The number at `at` as an index, if it is one.
    pub(crate) fn index(&self, at: usize) -> Option<usize> {
        self.values.get(at).copied().and_then(whole)
    }

    /// The numbers in groups of `N`, without an incomplete last group.
    pub(crate) const fn chunks<const N: usize>(&self) -> &'a [[f64; N]] {
        self.values.as_chunks().0
    }
}

/// A number as a count or index; `None` if it is negative or has a fraction.
#[expect(clippy::cast_possible_truncation, reason = "checked to be a whole number of 32 bits")]
pub(crate) fn whole(number: f64) -> Option<usize> {
    let is_whole = number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&number);
    is_whole.then_some(number as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_are_whole_and_not_negative() {
        assert_eq!([0.0, 7.0].map(whole), [Some(0), Some(7)]);
        for number in [-1.0, 0.5, 4_294_967_296.0, f64::NAN, f64::INFINITY] {
            assert_eq!(whole(number), None, "{number}");
        }
    }

    #[test]
    fn numbers_have_lines() {
        let lines = [[0, 4], [2, 5], [9, 8]];
        let numbers = Numbers { values: &[0.0; 4], first: 7, lines: &lines, line: 1 };
        assert_eq!([0, 1, 2, 3].map(|at| numbers.line_of(at)), [5, 5, 8, 8]);
        assert_eq!(Numbers::generated(&[1.0], 3).line_of(0), 3);
    }
}
