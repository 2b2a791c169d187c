//! A lane as a list of numbers, which any lane of any state of the same model can take over.
//!
//! So a job moves between states with different numbers of lanes, and so a checkpoint is made. A list of zeros is a lane
//! at rest.

/// What a lane has of its own.
pub trait LaneState {
    /// Appends the numbers of a lane.
    fn save_lane(&self, lane: usize, saved: &mut Vec<f64>);

    /// Sets a lane to numbers that were saved. Zeros bring it to rest.
    ///
    /// # Panics
    /// If there are fewer numbers than were saved.
    fn load_lane(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>);
}

/// The next numbers of a lane that was saved.
///
/// # Panics
/// If there are too few.
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

/// A part that not every model has.
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
