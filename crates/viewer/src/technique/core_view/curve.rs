//! The variables `width_curve` and `opacity_curve` of `strokes`: `0.3,1,0.3`.

use strokes::CURVE_LENGTH;

/// Reads two to eight numbers from 0 to `largest`, and interpolates them linearly at the
/// values of a curve.
pub(super) fn parse_curve(text: &str, largest: f32) -> Result<[f32; CURVE_LENGTH], String> {
    let message =
        || format!("expected 2 to {CURVE_LENGTH} numbers from 0 to {largest}, such as 0.3,1,0.3");
    let in_range = |number: &f32| (0.0..=largest).contains(number);
    let numbers: Option<Vec<f32>> =
        text.split(',').map(|number| number.trim().parse().ok().filter(in_range)).collect();
    let numbers = numbers
        .filter(|numbers| (2..=CURVE_LENGTH).contains(&numbers.len()))
        .ok_or_else(message)?;
    Ok(std::array::from_fn(|at| {
        // In whole sevenths of the way, so that the given numbers are exact.
        let place = at * (numbers.len() - 1);
        let (first, part) = (place / (CURVE_LENGTH - 1), place % (CURVE_LENGTH - 1));
        let next = (first + 1).min(numbers.len() - 1);
        #[expect(clippy::cast_precision_loss, reason = "at most seven")]
        let t = part as f32 / (CURVE_LENGTH - 1) as f32;
        numbers[first] * (1.0 - t) + numbers[next] * t
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_go_evenly_through_their_numbers() {
        assert_eq!(parse_curve("0, 7", 10.0), Ok([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]));
        for text in ["1", "1,2,x", "0.5,11", "1,1,1,1,1,1,1,1,1"] {
            assert!(parse_curve(text, 10.0).is_err(), "{text}");
        }
    }
}
