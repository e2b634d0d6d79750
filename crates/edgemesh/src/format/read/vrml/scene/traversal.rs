//! Visits the nodes of a file depth first, with an explicit stack.
//!
//! Each level of the stack holds the next node of its list, and a value that the walk gets
//! back at the end of the list.

use crate::format::read::vrml::parse::NodeRef;

/// The lists of nodes that are being visited, each within the previous one.
#[derive(Debug)]
pub(super) struct Traversal<'d, T> {
    levels: Vec<Level<'d, T>>,
}

/// A list of nodes.
#[derive(Debug)]
struct Level<'d, T> {
    next: Option<NodeRef<'d>>,
    /// How many more nodes of the list may be visited.
    left: usize,
    saved: T,
}

/// A step of a traversal.
#[derive(Debug)]
pub(super) enum Step<'d, T> {
    /// A node, through its `USE`.
    Node(NodeRef<'d>),
    /// The end of a list, with its saved value.
    Leave(T),
}

impl<'d, T> Traversal<'d, T> {
    /// A traversal of no nodes.
    pub(super) const fn new() -> Self {
        Self { levels: Vec::new() }
    }

    /// Enters a list at `first`, to visit at most `count` nodes.
    pub(super) fn enter(&mut self, first: Option<NodeRef<'d>>, count: usize, saved: T) {
        self.levels.push(Level { next: first, left: count, saved });
    }

    /// The next step; `None` at the end.
    pub(super) fn step(&mut self) -> Option<Step<'d, T>> {
        let level = self.levels.last_mut()?;
        if let Some(node) = level.next.filter(|_| level.left > 0) {
            level.next = node.next();
            level.left -= 1;
            return Some(Step::Node(node.target()));
        }
        self.levels.pop().map(|level| Step::Leave(level.saved))
    }

    /// The saved value of the innermost list.
    pub(super) fn saved(&self) -> Option<&T> {
        self.levels.last().map(|level| &level.saved)
    }
}

/// The node number `at` of the list that begins with `first`; `None` past its end.
pub(super) fn nth(first: Option<NodeRef<'_>>, at: Option<usize>) -> Option<NodeRef<'_>> {
    std::iter::successors(first, |node| node.next()).nth(at?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::read::vrml::tests::parsed;

    #[test]
    fn lists_are_visited_from_where_they_are_entered() {
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
                        assert_eq!(traversal.saved(), Some(&"inside"));
                    }
                }
                Step::Leave(saved) => steps.push(format!("leave {saved}")),
            }
        }
        assert_eq!(steps, ["A", "C", "leave inside", "D", "leave root"]);
        let first = document.root().first_child();
        assert!(nth(first, None).is_none() && nth(first, Some(3)).is_none());
    }
}
