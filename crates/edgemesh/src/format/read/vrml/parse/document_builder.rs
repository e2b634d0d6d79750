//! Builds a [`Document`] while its file is parsed.
//!
//! The open nodes are on a stack, so a deep file needs memory but no recursion. The fields
//! of open nodes are on a second stack until their node closes, so that the fields of a
//! node are consecutive:
//!
//! ```text
//! Transform { translation 0 1 0 children Shape { geometry Box { size 2 2 2
//! open fields   translation, children | geometry | size
//! open nodes    Transform             | Shape    | Box
//! ```

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use indexmap::IndexSet;

use super::document::{Document, Field, Node, NodeId, Symbol};
use super::origin::Origin;
use super::version::Version;
use crate::format::read::error::{ReadError, ReadErrorKind};
use crate::index::{NONE, to_u32};

/// A document to which nodes and fields are added.
#[derive(Debug)]
pub(crate) struct DocumentBuilder {
    document: Document,
    symbols: IndexSet<Rc<str>>,
    /// The last complete node with each `DEF` name.
    defined: HashMap<Symbol, NodeId>,
    current: OpenNode,
    /// The open nodes around the current node.
    outer: Vec<OpenNode>,
    /// The fields of the open nodes.
    fields: Vec<Field>,
}

/// A node whose closing brace has not been read.
#[derive(Debug)]
struct OpenNode {
    node: NodeId,
    line: u32,
    /// The index of its first field among those of the open nodes.
    first_field: usize,
    last_child: NodeId,
    /// The last node of the current field.
    last_value: NodeId,
    /// The line of the opening bracket of the current list.
    list_line: Option<u32>,
}

impl OpenNode {
    const fn new(node: NodeId, line: u32, first_field: usize) -> Self {
        let (last_child, last_value) = (NONE, NONE);
        Self { node, line, first_field, last_child, last_value, list_line: None }
    }
}

/// The place of a node in its parent.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Slot {
    /// A child, between the fields.
    Child,
    /// A value of the last field.
    Value,
}

impl DocumentBuilder {
    /// A document with only the root node, which stands for the file.
    pub(crate) fn new(origin: Origin, version: Version) -> Self {
        let document = Document {
            origin,
            version,
            nodes: Vec::new(),
            fields: Vec::new(),
            numbers: Vec::new(),
            number_lines: Vec::new(),
            words: Vec::new(),
            symbols: Vec::new(),
            prototypes: HashSet::new(),
        };
        let mut builder = Self {
            document,
            symbols: IndexSet::new(),
            defined: HashMap::new(),
            current: OpenNode::new(0, 1, 0),
            outer: Vec::new(),
            fields: Vec::new(),
        };
        let kind = builder.symbol(b"");
        builder.push_node(kind, NONE, 1);
        builder
    }

    /// The file of the document.
    pub(crate) const fn origin(&self) -> &Origin {
        &self.document.origin
    }

    /// Opens a node; `name` is its `DEF` name.
    pub(crate) fn open_node(&mut self, kind: &[u8], name: Option<&[u8]>, line: u32, slot: Slot) {
        let kind = self.symbol(kind);
        let name = name.map_or(NONE, |name| self.symbol(name));
        let node = self.push_node(kind, name, line);
        self.attach(node, slot);
        let open = OpenNode::new(node, line, self.fields.len());
        self.outer.push(std::mem::replace(&mut self.current, open));
    }

    /// Closes the current node, whose name can be used from now on; returns whether there
    /// was one.
    pub(crate) fn close_node(&mut self) -> bool {
        let Some(outer) = self.outer.pop() else { return false };
        let closed = std::mem::replace(&mut self.current, outer);
        self.store_fields(&closed);
        let name = self.document.nodes[closed.node as usize].name;
        if name != NONE {
            self.defined.insert(name, closed.node);
        }
        true
    }

    /// Adds a `USE` of a named node; returns whether there is one.
    pub(crate) fn use_node(&mut self, name: &[u8], line: u32, slot: Slot) -> bool {
        let name = self.symbol(name);
        let Some(&target) = self.defined.get(&name) else { return false };
        let node = self.push_node(name, NONE, line);
        self.document.nodes[node as usize].target = target;
        self.attach(node, slot);
        true
    }

    /// Adds a node type that the file defines.
    pub(crate) fn add_prototype(&mut self, name: &[u8]) {
        let name = self.symbol(name);
        self.document.prototypes.insert(name);
    }

    /// Opens a field of the current node, to which the next values are added.
    pub(crate) fn open_field(&mut self, name: &[u8], line: u32) {
        let number = to_u32(self.document.numbers.len());
        let word = to_u32(self.document.words.len());
        let name = self.symbol(name);
        let (numbers, words) = ([number; 2], [word; 2]);
        self.fields.push(Field { name, line, numbers, words, first_node: NONE });
        self.current.last_value = NONE;
    }

    /// Adds a number to the current field.
    pub(crate) fn push_number(&mut self, number: f64, line: u32) {
        let document = &mut self.document;
        if document.number_lines.last().is_none_or(|&[_, last]| last != line) {
            document.number_lines.push([to_u32(document.numbers.len()), line]);
        }
        document.numbers.push(number);
        if let Some(field) = self.fields.last_mut() {
            field.numbers[1] = to_u32(document.numbers.len());
        }
    }

    /// Adds a string or a bare word to the current field.
    pub(crate) fn push_word(&mut self, word: &[u8]) {
        let symbol = self.symbol(word);
        self.document.words.push(symbol);
        if let Some(field) = self.fields.last_mut() {
            field.words[1] = to_u32(self.document.words.len());
        }
    }

    /// The line of the opening bracket of the current list, if one is open.
    pub(crate) const fn list_line(&self) -> Option<u32> {
        self.current.list_line
    }

    /// Opens a list in this line, or closes it.
    pub(crate) const fn set_list_line(&mut self, line: Option<u32>) {
        self.current.list_line = line;
    }

    /// The complete document.
    ///
    /// # Errors
    /// [`ReadErrorKind::Syntax`] if a bracket is open, with the line of the innermost one.
    pub(crate) fn finish(mut self) -> Result<Document, ReadError> {
        let syntax = |line, what| self.origin().error(ReadErrorKind::Syntax, line, what);
        if let Some(line) = self.current.list_line {
            return Err(syntax(line, "the list that begins here has no ']'"));
        }
        if !self.outer.is_empty() {
            return Err(syntax(self.current.line, "the node that begins here has no '}'"));
        }
        let root = std::mem::replace(&mut self.current, OpenNode::new(0, 1, 0));
        self.store_fields(&root);
        self.document.symbols = self.symbols.into_iter().collect();
        Ok(self.document)
    }

    fn symbol(&mut self, text: &[u8]) -> Symbol {
        let text = String::from_utf8_lossy(text);
        let index = self.symbols.get_index_of(&*text);
        to_u32(index.unwrap_or_else(|| self.symbols.insert_full(text.into()).0))
    }

    fn push_node(&mut self, kind: Symbol, name: Symbol, line: u32) -> NodeId {
        let id = to_u32(self.document.nodes.len());
        self.document.nodes.push(Node {
            kind,
            name,
            target: NONE,
            line,
            first_child: NONE,
            next: NONE,
            fields: [0; 2],
        });
        id
    }

    /// Links a node to the previous node of its list.
    fn attach(&mut self, node: NodeId, slot: Slot) {
        let last = match slot {
            Slot::Child => &mut self.current.last_child,
            Slot::Value => &mut self.current.last_value,
        };
        let previous = std::mem::replace(last, node);
        match (previous, slot) {
            (NONE, Slot::Child) => {
                self.document.nodes[self.current.node as usize].first_child = node;
            }
            (NONE, Slot::Value) => {
                if let Some(field) = self.fields.last_mut() {
                    field.first_node = node;
                }
            }
            _ => self.document.nodes[previous as usize].next = node,
        }
    }

    fn store_fields(&mut self, closed: &OpenNode) {
        let first = to_u32(self.document.fields.len());
        self.document.fields.extend(self.fields.drain(closed.first_field..));
        let end = to_u32(self.document.fields.len());
        self.document.nodes[closed.node as usize].fields = [first, end];
    }
}
