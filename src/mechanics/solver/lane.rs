//! A lane as a list of numbers, which any lane of any state of the same model can load.
//!
//! With it a job moves between states with different lane counts, and checkpoints are written. A list of zeros is a
//! lane at rest.

/// State that each lane has separately.
pub trait LaneState {
    /// Appends the numbers of a lane to `saved`.
    fn save_lane(&self, lane: usize, saved: &mut Vec<f64>);

    /// Sets a lane from saved numbers. Zeros bring it to rest.
    ///
    /// # Panics
    /// If there are fewer numbers than were saved.
    fn load_lane(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>);
}

/// The next `N` saved numbers of a lane.
///
/// # Panics
/// If there are fewer.
pub fn next<const N: usize>(saved: &mut dyn Iterator<Item = f64>) -> [f64; N] {
    std::array::from_fn(|_| saved.next().expect("as many numbers as were saved"))
}

/// One number per lane.
impl<const L: usize> LaneState for [f64; L] {
    fn save_lane(&self, lane: usize, saved: &mut Vec<f64>) {
        saved.push(self[lane]);
    }

    fn load_lane(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>) {
        [self[lane]] = next(saved);
    }
}

/// Several parts, one after the other.
impl<T: LaneState> LaneState for [T] {
    fn save_lane(&self, lane: usize, saved: &mut Vec<f64>) {
        for part in self {
            part.save_lane(lane, saved);
        }
    }

    fn load_lane(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>) {
        for part in self {
            part.load_lane(lane, saved);
        }
    }
}

/// A part that only some models have.
impl<T: LaneState> LaneState for Option<T> {
    fn save_lane(&self, lane: usize, saved: &mut Vec<f64>) {
        if let Some(part) = self {
            part.save_lane(lane, saved);
        }
    }

    fn load_lane(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>) {
        if let Some(part) = self {
            part.load_lane(lane, saved);
        }
    }
}
