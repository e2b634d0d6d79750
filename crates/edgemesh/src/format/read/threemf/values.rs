//! Values of attributes.
//!
//! ```text
//! transform   m00 m01 m02 m10 m11 m12 m20 m21 m22 m30 m31 m32, for rows:
//!             (x y z 1) * M, so the first three are where x goes, the last the shift
//! color       #RRGGBB or #RRGGBBAA, coded as sRGB
//! ```

use glam::{DAffine3, DVec3};

use super::super::number::parse_number;

/// The transform that `text` states.
pub(super) fn transform(text: &str) -> Option<DAffine3> {
    let mut numbers = text.split_ascii_whitespace().map(|word| parse_number(word.as_bytes()));
    let mut row = || Some(DVec3::new(numbers.next()??, numbers.next()??, numbers.next()??));
    let (x, y, z, shift) = (row()?, row()?, row()?, row()?);
    numbers.next().is_none().then(|| DAffine3::from_cols(x, y, z, shift))
}

/// Red, green, blue and, if stated, opacity, each from 0 to 1.
pub(super) fn color(text: &str) -> Option<([f32; 3], Option<f32>)> {
    let digits = text.trim().strip_prefix('#')?;
    if !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
        return None;
    }
    let channel = |at: usize| {
        let byte = u8::from_str_radix(digits.get(2 * at..2 * at + 2)?, 16).ok()?;
        Some(f32::from(byte) / 255.0)
    };
    let color = [channel(0)?, channel(1)?, channel(2)?];
    match digits.len() {
        6 => Some((color, None)),
        8 => Some((color, Some(channel(3)?))),
        _ => None,
    }
}

/// The length of a unit in meters.
pub(super) fn unit(word: &str) -> Option<f64> {
    Some(match word {
        "micron" => 1e-6,
        "millimeter" => 1e-3,
        "centimeter" => 1e-2,
        "inch" => 0.0254,
        "foot" => 0.3048,
        "meter" => 1.0,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transforms_have_rows() {
        let found = transform("1 0 0  0 0 1  0 -1 0  10 20 30").unwrap();
        assert_eq!(found.transform_point3(DVec3::new(1.0, 2.0, 3.0)), DVec3::new(11., 17., 32.));
        for text in
            ["", "1 0 0 0 1 0 0 0 1 0 0", "1 0 0 0 1 0 0 0 1 0 0 0 0", "x 0 0 0 1 0 0 0 1 0 0 0"]
        {
            assert_eq!(transform(text), None, "{text}");
        }
    }

    #[test]
    fn colors_have_six_or_eight_digits() {
        assert_eq!(color("#FF0033"), Some(([1.0, 0.0, 0.2], None)));
        assert_eq!(color(" #ff003366 "), Some(([1.0, 0.0, 0.2], Some(0.4))));
        for text in ["", "#", "FF0033", "#FF003", "#FF00333", "#GG0033", "#+f0033", "#ff00336é"] {
            assert_eq!(color(text), None, "{text}");
        }
    }
}
