//! Curves along strokes, as text: `0.3,1,0.3`.

use strokes::style::link_style::CURVE_LENGTH;

/// Two to eight numbers, spread evenly over the values of a curve.
pub(crate) fn parse_curve(value: &str, most: f32) -> Result<[f32; CURVE_LENGTH], String> {
    let what = || format!("needs 2 to {CURVE_LENGTH} numbers from 0 to {most}, as 0.3,1,0.3");
    let numbers: Option<Vec<f32>> = value
        .split(',')
        .map(|number| number.trim().parse().ok().filter(|number| (0.0..=most).contains(number)))
        .collect();
    let numbers =
        numbers.filter(|numbers| (2..=CURVE_LENGTH).contains(&numbers.len())).ok_or_else(what)?;
    Ok(std::array::from_fn(|at| {
        // In sevenths of the way: exact where there is a number.
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
