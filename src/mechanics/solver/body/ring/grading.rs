//! Element sizes that grow with the distance from a fine region.

/// Largest ratio of the sizes of neighbouring elements.
const GROWTH: f64 = 1.4;

/// Sizes \[m or rad\] of the elements over `length`: as few elements as possible, with sizes of neighbours that
/// differ by a factor of at most 1.4.
///
/// The first element has the size `fine`, and none is larger than `coarse`. If equal elements are enough, all have
/// the same size, at most `fine`. The list is empty if `length` is not positive.
pub fn graded(length: f64, fine: f64, coarse: f64) -> Vec<f64> {
    if length <= 0.0 {
        return Vec::new();
    }
    let total = |count: usize, growth: f64| -> f64 { sizes(count, fine, coarse, growth).sum() };
    // The factor covers the rounding of decimal lengths.
    let enough = length * (1.0 - 1.0e-9);
    let most = (length / fine).ceil().max(1.0) as usize;
    let count = (1..most).find(|&count| total(count, GROWTH) >= enough).unwrap_or(most);
    if total(count, 1.0) >= enough {
        return vec![length / count as f64; count];
    }
    let (mut low, mut high) = (1.0, GROWTH);
    // 64 halvings reach the precision of f64.
    for _ in 0..64 {
        let middle = 0.5 * (low + high);
        if total(count, middle) < length {
            low = middle;
        } else {
            high = middle;
        }
    }
    sizes(count, fine, coarse, high).collect()
}

fn sizes(count: usize, fine: f64, coarse: f64, growth: f64) -> impl Iterator<Item = f64> {
    std::iter::successors(Some(fine), move |size| Some((size * growth).min(coarse))).take(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: the elements fill the length, begin fine, and keep to the limits of growth and size.
    #[test]
    fn sizes_fill_the_length_within_the_limits() {
        for (length, fine, coarse) in
            [(0.085, 0.0025, 0.012), (0.0154, 0.0025, 0.012), (0.002, 0.0025, 0.012)]
        {
            let found = graded(length, fine, coarse);
            assert!((found.iter().sum::<f64>() / length - 1.0).abs() < 1e-9, "{found:?}");
            assert!(found[0] <= fine * (1.0 + 1e-9));
            assert!(found.iter().all(|size| *size <= coarse * (1.0 + 1e-9)));
            assert!(found.windows(2).all(|pair| pair[1] / pair[0] <= GROWTH + 1e-9 && pair[1] >= pair[0]));
        }
    }

    /// Protects: equal target sizes give equal elements.
    #[test]
    fn without_a_coarse_size_all_elements_are_equal() {
        assert_eq!(graded(0.01, 0.001, 0.001), vec![0.001; 10]);
        assert_eq!(graded(0.0105, 0.001, 0.001), vec![0.0105 / 11.0; 11]);
    }
}
