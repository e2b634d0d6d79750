//! Filters: what decoded elements stand for.
//!
//! ```text
//! octahedral     x y 1 w       a unit vector as a point of an octahedron; 8 or 16 bits
//! quaternion     x y z 1|i     the three smaller components, the place of the largest
//! exponential    m e           m * 2^e, 24 and 8 bits
//! color          y co cg a     YCoCg; the highest bit of a says how many bits there are
//! ```

use std::f32::consts::FRAC_1_SQRT_2;

use serde::Deserialize;

/// What a decoded element stands for.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub(super) enum Filter {
    /// Itself.
    #[default]
    None,
    Octahedral,
    Quaternion,
    Exponential,
    Color,
}

impl Filter {
    /// Whether elements may have `stride` bytes.
    pub(super) const fn takes(self, stride: u64) -> bool {
        match self {
            Self::None => true,
            Self::Octahedral | Self::Color => stride == 4 || stride == 8,
            Self::Quaternion => stride == 8,
            Self::Exponential => stride.is_multiple_of(4),
        }
    }

    /// Replaces all elements of `stride` bytes by what they stand for. Where that is not
    /// specified, it is any number.
    pub(super) fn apply(self, bytes: &mut [u8], stride: usize) {
        match (self, stride) {
            (Self::None, _) => {}
            (Self::Octahedral, 4) => each(bytes, |[x, y, one, w]: [u8; 4]| {
                let unit = octahedral([x, y, one].map(|byte| f32::from(byte.cast_signed())));
                let [x, y, z] = unit.map(|part| to_i8(part * 127.0).cast_unsigned());
                [x, y, z, w]
            }),
            (Self::Octahedral, _) => each(bytes, |element: [u8; 8]| {
                let [x, y, one, w] = shorts(element);
                let [x, y, z] =
                    octahedral([x, y, one].map(f32::from)).map(|part| to_i16(part * 32_767.0));
                from_shorts([x, y, z, w])
            }),
            (Self::Quaternion, _) => {
                each(bytes, |element| from_shorts(quaternion(shorts(element))))
            }
            (Self::Exponential, _) => each(bytes, |element: [u8; 4]| {
                exponential(i32::from_le_bytes(element)).to_le_bytes()
            }),
            (Self::Color, 4) => each(bytes, |[y, co, cg, a]: [u8; 4]| {
                let [co, cg] = [co, cg].map(|byte| i32::from(byte.cast_signed()));
                color([y.into(), co, cg, a.into()], 255.0).map(to_u8)
            }),
            (Self::Color, _) => each(bytes, |element: [u8; 8]| {
                let [y, co, cg, a] = shorts(element);
                let [y, a] = [y, a].map(|short| i32::from(short.cast_unsigned()));
                let found = color([y, co.into(), cg.into(), a], 65_535.0).map(to_u16);
                from_shorts(found.map(u16::cast_signed))
            }),
        }
    }
}

/// Replaces each `N` bytes.
fn each<const N: usize>(bytes: &mut [u8], convert: impl Fn([u8; N]) -> [u8; N]) {
    for element in bytes.as_chunks_mut::<N>().0 {
        *element = convert(*element);
    }
}

/// The unit vector of a point of the octahedron; the third number stands for 1.
fn octahedral([x, y, one]: [f32; 3]) -> [f32; 3] {
    let (x, y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    // The lower half is folded over the edges of the upper one.
    let fold = z.min(0.0);
    let (x, y) = (x - fold.copysign(x), y - fold.copysign(y));
    let length = (x * x + y * y + z * z).sqrt();
    [x, y, z].map(|part| part / length)
}

/// The four components of a unit quaternion, of which the largest is missing.
fn quaternion([x, y, z, last]: [i16; 4]) -> [i16; 4] {
    let one = f32::from(last | 3);
    let [x, y, z] = [x, y, z].map(|part| f32::from(part) / one * FRAC_1_SQRT_2);
    let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    let mut turned = [w, x, y, z].map(|part| to_i16(part * 32_767.0));
    turned.rotate_right((last & 3).unsigned_abs().into());
    turned
}

fn exponential(value: i32) -> f32 {
    let exponent = value >> 24;
    let mantissa = (value << 8) >> 8;
    let number = f64::from(mantissa) * 2_f64.powi(exponent);
    #[expect(clippy::cast_possible_truncation, reason = "24 bits fit")]
    let number = number as f32;
    number
}

/// Red, green, blue and opacity from 0 to `most`.
fn color([y, co, cg, a]: [i32; 4], most: f32) -> [f32; 4] {
    let Some(highest) = a.checked_ilog2() else { return [0.0; 4] };
    let all = (1 << (highest + 1)) - 1;
    let (r, g, b) = (y + co - cg, y + cg, y - co - cg);
    let opacity = a & (all >> 1);
    let opacity = opacity << 1 | opacity & 1;
    [r, g, b, opacity].map(|part| part as f32 * (most / all as f32))
}

fn shorts(bytes: [u8; 8]) -> [i16; 4] {
    let pairs = bytes.as_chunks::<2>().0;
    std::array::from_fn(|at| pairs.get(at).map_or(0, |&pair| i16::from_le_bytes(pair)))
}

fn from_shorts([a, b, c, d]: [i16; 4]) -> [u8; 8] {
    let [[a, b], [c, d], [e, f], [g, h]] = [a, b, c, d].map(i16::to_le_bytes);
    [a, b, c, d, e, f, g, h]
}

#[expect(clippy::cast_possible_truncation, reason = "numbers out of range saturate")]
const fn to_i8(number: f32) -> i8 {
    number.round() as i8
}

#[expect(clippy::cast_possible_truncation, reason = "numbers out of range saturate")]
const fn to_i16(number: f32) -> i16 {
    number.round() as i16
}

#[expect(clippy::cast_possible_truncation, reason = "numbers out of range saturate")]
#[expect(clippy::cast_sign_loss, reason = "numbers out of range saturate")]
const fn to_u8(number: f32) -> u8 {
    number.round() as u8
}

#[expect(clippy::cast_possible_truncation, reason = "numbers out of range saturate")]
#[expect(clippy::cast_sign_loss, reason = "numbers out of range saturate")]
const fn to_u16(number: f32) -> u16 {
    number.round() as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(filter: Filter, element: [i8; 4]) -> [i8; 4] {
        let mut bytes = element.map(i8::cast_unsigned);
        filter.apply(&mut bytes, 4);
        bytes.map(u8::cast_signed)
    }

    fn words(filter: Filter, element: [i16; 4]) -> [i16; 4] {
        let mut bytes = from_shorts(element);
        filter.apply(&mut bytes, 8);
        shorts(bytes)
    }

    #[test]
    fn octahedrons_have_eight_faces() {
        let unit = |element| bytes(Filter::Octahedral, element);
        assert_eq!(unit([0, 0, 127, 5]), [0, 0, 127, 5]);
        assert_eq!(unit([127, 0, 127, 0]), [127, 0, 0, 0]);
        assert_eq!(unit([0, -127, 127, 0]), [0, -127, 0, 0]);
        assert_eq!(unit([127, 127, 127, -1]), [0, 0, -127, -1], "a corner is the lower pole");
        // On an edge: 64 and 63 of their length, sqrt 8065, times 127. With 3 bits, 1 is 3.
        assert_eq!(unit([64, 63, 127, 0]), [91, 89, 0, 0]);
        assert_eq!(unit([3, 0, 3, 0]), [127, 0, 0, 0]);
        // Of 16 bits: (0.5, 0.25, 0.25) has the length sqrt 0.375.
        let found = words(Filter::Octahedral, [16_384, 8192, 32_767, 7]);
        for (found, expected) in found.into_iter().zip([26_754, 13_377, 13_377, 7]) {
            assert!((i32::from(found) - expected).abs() <= 1, "{found} {expected}");
        }
        let _ = (unit([1, 1, 0, 0]), words(Filter::Octahedral, [0; 4]), "not specified");
    }

    #[test]
    fn quaternions_have_a_missing_component() {
        let unit = |element| words(Filter::Quaternion, element);
        // The largest is component 3 (w), 2 bits that stand in the last number.
        assert_eq!(unit([0, 0, 0, 0x7ffc | 3]), [0, 0, 0, 32_767]);
        assert_eq!(unit([0, 0, 0, 0x7ffc]), [32_767, 0, 0, 0]);
        // A full component is 1 / sqrt 2, which leaves 1 / sqrt 2: 23,170 of 32,767. The
        // first of three follows the largest.
        assert_eq!(unit([32_767, 0, 0, 0x7ffc | 1]), [0, 23_170, 23_170, 0]);
        assert_eq!(unit([0, 0, -32_767, 0x7ffc | 1]), [-23_170, 23_170, 0, 0]);
        let _ = (unit([i16::MIN; 4]), unit([5, 5, 5, -4]), "not specified");
    }

    #[test]
    fn exponentials_are_exact() {
        let number = |exponent: i8, mantissa: i32| {
            let value = i32::from(exponent) << 24 | mantissa & 0xff_ffff;
            let mut bytes = value.to_le_bytes();
            Filter::Exponential.apply(&mut bytes, 4);
            f32::from_le_bytes(bytes)
        };
        assert_eq!((number(0, 5), number(-2, 3), number(4, -3)), (5.0, 0.75, -48.0));
        assert_eq!(number(-23, 0x7f_ffff), 0x7f_ffff as f32 / 8_388_608.0);
        assert_eq!((number(100, 1), number(-100, -1)), (2_f32.powi(100), -2_f32.powi(-100)));
    }

    #[test]
    fn colors_are_scaled_to_their_bits() {
        // 8 bits: a has its highest bit set, and 0x7f below it, all ones. r = 100 + 20 -
        // 10, g = 100 + 10, b = 100 - 20 - 10.
        let found = bytes(Filter::Color, [100, 20, 10, 0xff_u8.cast_signed()]);
        assert_eq!(found.map(i8::cast_unsigned), [110, 110, 70, 255]);
        // 4 bits: 15 is 255, so 1 is 17; the opacity 0b011 becomes 0b0111.
        let found = bytes(Filter::Color, [8, 2, 1, 0b1011]);
        assert_eq!(found.map(i8::cast_unsigned), [9 * 17, 9 * 17, 5 * 17, 7 * 17]);
        // 12 bits in 16: 4095 is 65,535; 2048 is 32,775.5 of that.
        let found = words(Filter::Color, [2048, 0, 0, 0xfff]);
        let channel = 32_776_u16.cast_signed();
        assert_eq!(found, [channel, channel, channel, -1]);
        assert_eq!(bytes(Filter::Color, [9, 9, 9, 0]), [0; 4], "not specified");
    }
}
