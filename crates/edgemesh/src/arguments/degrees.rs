//! Angles as arguments.

/// Reads a number of degrees from `low` to `high`.
///
/// # Errors
/// Returns the expected range if `text` is no number or outside of it.
pub(super) fn parse_degrees(text: &str, low: f64, high: f64) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(degrees) if (low..=high).contains(&degrees) => Ok(degrees),
        _ => Err(format!("needs a number of degrees from {low} to {high}")),
    }
}
