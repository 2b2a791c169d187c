//! Results with the digits that their error leaves.

use super::value::{MISSING, fixed};

/// The power of ten of the last digit that an error leaves: that of its first digit, or of its second one if the first is
/// 1, because rounding would change such an error by a third. `0.048` gives −2, and `0.0143` gives −3. None for an error
/// that is 0 or unknown.
pub fn last_place(error: f64) -> Option<i32> {
    let error = error.abs();
    if error == 0.0 || !error.is_finite() {
        return None;
    }
    let place = error.log10().floor() as i32;
    Some(if error / 10_f64.powi(place) < 1.95 { place - 1 } else { place })
}

/// A number rounded at a power of ten; [`MISSING`] if it is not finite.
pub fn at_place(x: f64, place: i32) -> String {
    if !x.is_finite() {
        return MISSING.to_owned();
    }
    if place < 0 {
        return fixed(x, place.unsigned_abs() as usize);
    }
    let unit = 10_f64.powi(place);
    format!("{:.0}", (x / unit).round() * unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: the error decides on the last digit, before and behind the point, and an error of 1 to 2 leaves one digit
    /// more.
    #[test]
    fn an_error_decides_on_the_digits() {
        let cases = [
            (0.263_429, 0.0143, "0.263"),
            (0.254_538, 0.0048, "0.255"),
            (0.254_538, 0.03, "0.25"),
            (15_571.5, 39.0, "15570"),
            (15_571.5, 3.0, "15572"),
            (0.3, 0.000_96, "0.3000"),
            (2.0, 0.5, "2.0"),
        ];
        for (x, error, text) in cases {
            assert_eq!(at_place(x, last_place(error).unwrap()), text, "{x} ± {error}");
        }
        assert_eq!((last_place(0.0), last_place(f64::NAN)), (None, None));
        assert_eq!(at_place(f64::NAN, -2), MISSING);
    }
}
