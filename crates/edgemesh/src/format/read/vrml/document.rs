//! A file as a tree of nodes, in lists instead of pointers.
//!
//! ```text
//! nodes   Group -> Shape -> ...        each knows its first child and its next sibling
//! fields  (name, numbers a..b, words c..d, first node)   those of a node in a row
//! numbers 0 0 0 1 0 0 ...              one list for the whole file, with lines beside it
//! ```
//!
//! Both versions fit in: what VRML 1.0 calls children stand bare between the
//! fields of a node, what VRML 97 calls children are the nodes of a field.
//! A `USE` is a node of its own that points at its target, which always stands
//! before it and is whole; so there are no cycles, and [`NodeRef`] goes on to
//! the target by itself.
//!
//! Rejected: a Rust tree of boxes, whose drop alone overflows the stack at
//! 100,000 nested groups.

use std::collections::HashSet;
use std::ops::Range;
use std::rc::Rc;

use super::Version;
use super::origin::Origin;
use crate::index::NONE;

/// Index of a node in [`Document`].
pub(super) type NodeId = u32;

/// Index of a name or string in [`Document`].
pub(super) type Symbol = u32;

/// A file that was parsed.
#[derive(Debug)]
pub(super) struct Document {
    /// Where it came from.
    pub(super) origin: Origin,
    /// Its version.
    pub(super) version: Version,
    /// The nodes; the first one stands for the file and holds what is in it.
    pub(super) nodes: Vec<Node>,
    /// The fields, node by node.
    pub(super) fields: Vec<Field>,
    /// The numbers, field by field.
    pub(super) numbers: Vec<f64>,
    /// The lines of numbers: the first number of a line, and the line.
    pub(super) number_lines: Vec<[u32; 2]>,
    /// The strings and bare words, field by field.
    pub(super) words: Vec<Symbol>,
    /// Every name and string once.
    pub(super) symbols: Vec<Rc<str>>,
    /// The types of nodes that a `PROTO` or `EXTERNPROTO` defines.
    pub(super) prototypes: HashSet<Symbol>,
}

/// One node, or one `USE` of a node.
#[derive(Debug)]
pub(super) struct Node {
    /// Its type.
    pub(super) kind: Symbol,
    /// Its `DEF` name, or [`NONE`].
    pub(super) name: Symbol,
    /// The node that a `USE` stands for, or [`NONE`].
    pub(super) target: NodeId,
    /// The line of its type.
    pub(super) line: u32,
    /// Its first child, or [`NONE`].
    pub(super) first_child: NodeId,
    /// The one after it in its list, or [`NONE`].
    pub(super) next: NodeId,
    /// Its first field and the one behind its last.
    pub(super) fields: [u32; 2],
}

/// One field of a node, with its values by kind.
#[derive(Debug)]
pub(super) struct Field {
    /// Its name.
    pub(super) name: Symbol,
    /// Its line.
    pub(super) line: u32,
    /// Its first number and the one behind its last.
    pub(super) numbers: [u32; 2],
    /// Its first word and the one behind its last.
    pub(super) words: [u32; 2],
    /// Its first node, or [`NONE`].
    pub(super) first_node: NodeId,
}

impl Document {
    /// The node that stands for the whole file.
    pub(super) const fn root(&self) -> NodeRef<'_> {
        NodeRef { document: self, id: 0 }
    }

    /// How much there is in the file: nodes, fields, numbers and words.
    pub(super) const fn element_count(&self) -> usize {
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

/// A node of a document.
#[derive(Debug, Clone, Copy)]
pub(super) struct NodeRef<'a> {
    /// The document.
    pub(super) document: &'a Document,
    /// The node in it.
    id: NodeId,
}

impl<'a> NodeRef<'a> {
    fn node(self) -> &'a Node {
        &self.document.nodes[self.id as usize]
    }

    /// The node that is meant: itself, or what a `USE` points at.
    pub(super) fn target(self) -> Self {
        self.document.node(self.node().target).unwrap_or(self)
    }

    /// A number of its own for each node of this document.
    pub(super) const fn id(self) -> NodeId {
        self.id
    }

    /// Its type.
    pub(super) fn kind(self) -> &'a str {
        self.document.symbol(self.node().kind)
    }

    /// Its `DEF` name.
    pub(super) fn name(self) -> Option<&'a Rc<str>> {
        Some(self.node().name).filter(|&name| name != NONE).map(|name| self.document.symbol(name))
    }

    /// The line of its type.
    pub(super) fn line(self) -> u32 {
        self.node().line
    }

    /// Whether its type is one that the file defines.
    pub(super) fn is_prototype(self) -> bool {
        self.document.prototypes.contains(&self.node().kind)
    }

    /// Its first child.
    pub(super) fn first_child(self) -> Option<Self> {
        self.document.node(self.node().first_child)
    }

    /// The one after it in the list that it stands in.
    pub(super) fn next(self) -> Option<Self> {
        self.document.node(self.node().next)
    }

    /// Its fields in the order of the file.
    pub(super) fn fields(self) -> impl DoubleEndedIterator<Item = FieldRef<'a>> {
        let document = self.document;
        let fields = &document.fields[as_range(self.node().fields)];
        fields.iter().map(move |field| FieldRef { document, field })
    }

    /// How many fields it has.
    pub(super) fn field_count(self) -> usize {
        as_range(self.node().fields).len()
    }

    /// The field of this name; the last one, where there are several.
    pub(super) fn field(self, name: &str) -> Option<FieldRef<'a>> {
        self.fields().rfind(|field| field.name() == name)
    }

    /// The node of a field, through its `USE`.
    pub(super) fn node_of(self, field: &str) -> Option<Self> {
        self.field(field)?.first_node().map(Self::target)
    }

    /// The numbers of a field; none where it is not there.
    pub(super) fn numbers(self, field: &str) -> Numbers<'a> {
        self.field(field).map_or_else(Numbers::default, FieldRef::numbers)
    }

    /// The first number of a field.
    pub(super) fn number(self, field: &str, default: f64) -> f64 {
        self.numbers(field).values.first().copied().unwrap_or(default)
    }

    /// The first `N` numbers of a field.
    pub(super) fn vector<const N: usize>(self, field: &str, default: [f64; N]) -> [f64; N] {
        self.numbers(field).values.first_chunk().copied().unwrap_or(default)
    }

    /// The strings and bare words of a field.
    pub(super) fn words(self, field: &str) -> impl Iterator<Item = &'a str> {
        let document = self.document;
        let range = self.field(field).map_or(0..0, |field| as_range(field.field.words));
        document.words[range].iter().map(|&word| &**document.symbol(word))
    }

    /// The first word of a field.
    pub(super) fn word(self, field: &str) -> Option<&'a str> {
        self.words(field).next()
    }

    /// `TRUE` or `FALSE`.
    pub(super) fn flag(self, field: &str, default: bool) -> bool {
        self.word(field).map_or(default, |word| word == "TRUE")
    }
}

/// A field of a node.
#[derive(Debug, Clone, Copy)]
pub(super) struct FieldRef<'a> {
    document: &'a Document,
    field: &'a Field,
}

impl<'a> FieldRef<'a> {
    /// Its name.
    pub(super) fn name(self) -> &'a str {
        self.document.symbol(self.field.name)
    }

    /// Its numbers.
    pub(super) fn numbers(self) -> Numbers<'a> {
        Numbers {
            values: &self.document.numbers[as_range(self.field.numbers)],
            first: self.field.numbers[0],
            lines: &self.document.number_lines,
            line: self.field.line,
        }
    }

    /// Its first node, perhaps a `USE`.
    pub(super) fn first_node(self) -> Option<NodeRef<'a>> {
        self.document.node(self.field.first_node)
    }
}

/// Numbers in a row, with their lines.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Numbers<'a> {
    /// The numbers.
    pub(super) values: &'a [f64],
    /// Where in the file's numbers they start.
    first: u32,
    /// The lines of the file's numbers; none for numbers that are not in it.
    lines: &'a [[u32; 2]],
    /// The line of all, where `lines` does not say.
    line: u32,
}

impl<'a> Numbers<'a> {
    /// Numbers that were made for something in `line`.
    pub(super) const fn made(values: &'a [f64], line: u32) -> Self {
        Self { values, first: 0, lines: &[], line }
    }

    /// The line of a number.
    pub(super) fn line_of(&self, at: usize) -> u32 {
        let number = self.first as usize + at;
        let later = self.lines.partition_point(|&[first, _]| first as usize <= number);
        match later.checked_sub(1).and_then(|last| self.lines.get(last)) {
            Some(&[_, line]) => line,
            None => self.line,
        }
    }

    /// The whole number at `at`, unless it is negative or has a fraction.
    pub(super) fn index(&self, at: usize) -> Option<usize> {
        self.values.get(at).copied().and_then(whole)
    }

    /// Groups of `N` numbers; a last one that is not whole is left out.
    pub(super) const fn chunks<const N: usize>(&self) -> &'a [[f64; N]] {
        self.values.as_chunks().0
    }
}

/// A number as a count or index, unless it is negative or has a fraction.
#[expect(clippy::cast_possible_truncation, reason = "checked to be a whole number of 32 bits")]
pub(super) fn whole(number: f64) -> Option<usize> {
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
    fn numbers_know_their_lines() {
        let lines = [[0, 4], [2, 5], [9, 8]];
        let numbers = Numbers { values: &[0.0; 4], first: 7, lines: &lines, line: 1 };
        assert_eq!([0, 1, 2, 3].map(|at| numbers.line_of(at)), [5, 5, 8, 8]);
        assert_eq!(Numbers::made(&[1.0], 3).line_of(0), 3);
    }
}
