//! Names in text formats, in which a line end ends a statement.

/// A name without line ends and other control characters.
pub(super) fn one_line(name: &str) -> String {
    name.replace(char::is_control, " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_in_their_line() {
        assert_eq!(one_line("gr\u{fc}n \"a\"\r\nf 1 2 3"), "gr\u{fc}n \"a\"  f 1 2 3");
    }
}
