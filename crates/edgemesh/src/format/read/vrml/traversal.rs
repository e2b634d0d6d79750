//! The way through the nodes of a file, depth first, on a stack of its own.
//!
//! Each level waits at the node that comes next in its list, with something
//! that the walk wants back when the list is done.

use super::document::NodeRef;

/// Lists of nodes that are being walked, each inside of the one before it.
#[derive(Debug)]
pub(super) struct Traversal<'d, T> {
    levels: Vec<Level<'d, T>>,
}

#[derive(Debug)]
struct Level<'d, T> {
    next: Option<NodeRef<'d>>,
    /// How many nodes of the list are left to be walked at most.
    left: usize,
    kept: T,
}

/// What comes next.
#[derive(Debug)]
pub(super) enum Step<'d, T> {
    /// A node, through its `USE`.
    Node(NodeRef<'d>),
    /// The end of a list, with what was kept for it.
    Leave(T),
}

impl<'d, T> Traversal<'d, T> {
    /// Nothing to walk yet.
    pub(super) const fn new() -> Self {
        Self { levels: Vec::new() }
    }

    /// Goes into a list, from `first` on; `count` nodes at most are walked.
    pub(super) fn enter(&mut self, first: Option<NodeRef<'d>>, count: usize, kept: T) {
        self.levels.push(Level { next: first, left: count, kept });
    }

    /// The next step; `None` when all is done.
    pub(super) fn step(&mut self) -> Option<Step<'d, T>> {
        let level = self.levels.last_mut()?;
        if let Some(node) = level.next.filter(|_| level.left > 0) {
            level.next = node.next();
            level.left -= 1;
            return Some(Step::Node(node.target()));
        }
        self.levels.pop().map(|level| Step::Leave(level.kept))
    }

    /// What is kept for the list that the last node stands in.
    pub(super) fn kept(&self) -> Option<&T> {
        self.levels.last().map(|level| &level.kept)
    }
}

/// The node number `at` of a list; negative numbers and those past the end are
/// none.
pub(super) fn nth(first: Option<NodeRef<'_>>, at: Option<usize>) -> Option<NodeRef<'_>> {
    std::iter::successors(first, |node| node.next()).nth(at?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::read::vrml::parsed;

    #[test]
    fn lists_are_walked_from_where_they_are_entered() {
        let document = parsed("#VRML V1.0 ascii\nA { B { } C { } } D { } E { }");
        let mut traversal = Traversal::new();
        traversal.enter(document.root().first_child(), 2, "root");
        let mut steps = Vec::new();
        while let Some(step) = traversal.step() {
            match step {
                Step::Node(node) => {
                    steps.push(node.kind().to_owned());
                    if node.kind() == "A" {
                        traversal.enter(nth(node.first_child(), Some(1)), usize::MAX, "inside");
                        assert_eq!(traversal.kept(), Some(&"inside"));
                    }
                }
                Step::Leave(kept) => steps.push(format!("leave {kept}")),
            }
        }
        assert_eq!(steps, ["A", "C", "leave inside", "D", "leave root"]);
        let first = document.root().first_child();
        assert!(nth(first, None).is_none() && nth(first, Some(3)).is_none());
    }
}
