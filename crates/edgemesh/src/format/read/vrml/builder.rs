//! Puts a [`Document`] together while its file is parsed.
//!
//! One node is open at a time, the others wait on a stack, so the depth of a
//! file costs memory only. The fields of open nodes wait on a second stack
//! until their node closes and they can lie in a row:
//!
//! ```text
//! Transform { translation 0 1 0 children Shape { geometry Box { size 2 2 2
//! fields waiting   translation, children | geometry | size
//! nodes open       Transform             | Shape    | Box
//! ```

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use super::Version;
use super::document::{Document, Field, Node, NodeId, Symbol};
use super::origin::Origin;
use crate::format::read::error::{ReadError, ReadErrorKind};
use crate::index::{NONE, to_u32};

/// A document in the making.
#[derive(Debug)]
pub(super) struct Builder {
    document: Document,
    symbols: HashMap<Rc<str>, Symbol>,
    /// The node that a name stands for from here on.
    defined: HashMap<Symbol, NodeId>,
    current: Open,
    /// The open nodes around the current one.
    outer: Vec<Open>,
    /// The fields of all open nodes.
    fields: Vec<Field>,
}

/// A node whose brace is not closed yet.
#[derive(Debug)]
struct Open {
    node: NodeId,
    line: u32,
    /// The first of its fields among those of all open nodes.
    first_field: usize,
    last_child: NodeId,
    /// The last node of the field that is being read.
    last_value: NodeId,
    /// The line where the list starts that is being read.
    list_line: Option<u32>,
}

impl Open {
    const fn new(node: NodeId, line: u32, first_field: usize) -> Self {
        let (last_child, last_value) = (NONE, NONE);
        Self { node, line, first_field, last_child, last_value, list_line: None }
    }
}

/// Where in its parent a node stands.
#[derive(Debug, Clone, Copy)]
pub(super) enum Slot {
    /// Between the fields.
    Child,
    /// In the field that was opened last.
    Value,
}

impl Builder {
    /// A document with nothing in it but the node for the file.
    pub(super) fn new(origin: Origin, version: Version) -> Self {
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
            symbols: HashMap::new(),
            defined: HashMap::new(),
            current: Open::new(0, 1, 0),
            outer: Vec::new(),
            fields: Vec::new(),
        };
        let kind = builder.symbol(b"");
        builder.push_node(kind, NONE, 1);
        builder
    }

    /// The file that is parsed.
    pub(super) const fn origin(&self) -> &Origin {
        &self.document.origin
    }

    /// Opens a node; `name` is that of its `DEF`.
    pub(super) fn open_node(&mut self, kind: &[u8], name: Option<&[u8]>, line: u32, slot: Slot) {
        let kind = self.symbol(kind);
        let name = name.map_or(NONE, |name| self.symbol(name));
        let node = self.push_node(kind, name, line);
        self.attach(node, slot);
        let open = Open::new(node, line, self.fields.len());
        self.outer.push(std::mem::replace(&mut self.current, open));
    }

    /// Closes the current node, whose name can be used from here on; says
    /// whether there was one.
    pub(super) fn close_node(&mut self) -> bool {
        let Some(outer) = self.outer.pop() else { return false };
        let closed = std::mem::replace(&mut self.current, outer);
        self.keep_fields(&closed);
        let name = self.document.nodes[closed.node as usize].name;
        if name != NONE {
            self.defined.insert(name, closed.node);
        }
        true
    }

    /// Adds what an earlier `DEF` named; says whether there was one.
    pub(super) fn use_node(&mut self, name: &[u8], line: u32, slot: Slot) -> bool {
        let name = self.symbol(name);
        let Some(&target) = self.defined.get(&name) else { return false };
        let node = self.push_node(name, NONE, line);
        self.document.nodes[node as usize].target = target;
        self.attach(node, slot);
        true
    }

    /// Notes a type of nodes that the file defines itself.
    pub(super) fn add_prototype(&mut self, name: &[u8]) {
        let name = self.symbol(name);
        self.document.prototypes.insert(name);
    }

    /// Opens a field of the current node; the values that follow are its own.
    pub(super) fn open_field(&mut self, name: &[u8], line: u32) {
        let number = to_u32(self.document.numbers.len());
        let word = to_u32(self.document.words.len());
        let name = self.symbol(name);
        let (numbers, words) = ([number; 2], [word; 2]);
        self.fields.push(Field { name, line, numbers, words, first_node: NONE });
        self.current.last_value = NONE;
    }

    /// Adds a number to the field.
    pub(super) fn push_number(&mut self, number: f64, line: u32) {
        let document = &mut self.document;
        if document.number_lines.last().is_none_or(|&[_, last]| last != line) {
            document.number_lines.push([to_u32(document.numbers.len()), line]);
        }
        document.numbers.push(number);
        if let Some(field) = self.fields.last_mut() {
            field.numbers[1] = to_u32(document.numbers.len());
        }
    }

    /// Adds a string or a bare word to the field.
    pub(super) fn push_word(&mut self, word: &[u8]) {
        let symbol = self.symbol(word);
        self.document.words.push(symbol);
        if let Some(field) = self.fields.last_mut() {
            field.words[1] = to_u32(self.document.words.len());
        }
    }

    /// The line where the list starts that values go to now, if one is open.
    pub(super) const fn list_line(&self) -> Option<u32> {
        self.current.list_line
    }

    /// Opens the list of a field in `line`, or closes it.
    pub(super) const fn set_list_line(&mut self, line: Option<u32>) {
        self.current.list_line = line;
    }

    /// The document, where every node is closed.
    ///
    /// # Errors
    /// [`ReadErrorKind::Syntax`] with the line of the innermost open bracket.
    pub(super) fn finish(mut self) -> Result<Document, ReadError> {
        let syntax = |line, what| self.origin().error(ReadErrorKind::Syntax, line, what);
        if let Some(line) = self.current.list_line {
            return Err(syntax(line, "the list that starts here has no ']'"));
        }
        if !self.outer.is_empty() {
            return Err(syntax(self.current.line, "the node that starts here has no '}'"));
        }
        let root = std::mem::replace(&mut self.current, Open::new(0, 1, 0));
        self.keep_fields(&root);
        Ok(self.document)
    }

    fn symbol(&mut self, text: &[u8]) -> Symbol {
        let text = String::from_utf8_lossy(text);
        if let Some(&symbol) = self.symbols.get(&*text) {
            return symbol;
        }
        let symbol = to_u32(self.document.symbols.len());
        let text: Rc<str> = text.into();
        self.document.symbols.push(Rc::clone(&text));
        self.symbols.insert(text, symbol);
        symbol
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

    /// Puts a node behind the last one of the list that it stands in.
    fn attach(&mut self, node: NodeId, slot: Slot) {
        let last = match slot {
            Slot::Child => &mut self.current.last_child,
            Slot::Value => &mut self.current.last_value,
        };
        let before = std::mem::replace(last, node);
        match (before, slot) {
            (NONE, Slot::Child) => {
                self.document.nodes[self.current.node as usize].first_child = node;
            }
            (NONE, Slot::Value) => {
                if let Some(field) = self.fields.last_mut() {
                    field.first_node = node;
                }
            }
            _ => self.document.nodes[before as usize].next = node,
        }
    }

    fn keep_fields(&mut self, closed: &Open) {
        let first = to_u32(self.document.fields.len());
        self.document.fields.extend(self.fields.drain(closed.first_field..));
        let end = to_u32(self.document.fields.len());
        self.document.nodes[closed.node as usize].fields = [first, end];
    }
}
