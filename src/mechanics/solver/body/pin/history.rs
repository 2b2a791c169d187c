//! What the elements of a pin keep of their past.

use super::operator::Operator;
use crate::solver::lane::{LaneState, next};
use crate::solver::number::Number;

/// The numbers that elements keep, in the order number → lane. Linear forms keep none.
#[derive(Debug, Clone, PartialEq)]
pub struct History<const L: usize, R: Number>(Vec<R>);

impl<const L: usize, R: Number> History<L, R> {
    /// That of an undeformed pin.
    pub fn new(operator: &Operator) -> Self {
        Self::of_length(operator.history_len())
    }

    fn of_length(numbers: usize) -> Self {
        Self(vec![R::default(); L * numbers])
    }

    /// The history of one lane.
    pub fn of_lane(&self, lane: usize) -> History<1, f64> {
        History(self.0.iter().skip(lane).step_by(L).map(|number| number.to_f64()).collect())
    }

    /// Its numbers.
    pub fn numbers(&self) -> &[R] {
        &self.0
    }

    /// Its numbers, for a step that changes them.
    pub fn numbers_mut(&mut self) -> &mut [R] {
        &mut self.0
    }
}

impl<const L: usize, R: Number> LaneState for History<L, R> {
    fn save_lane(&self, lane: usize, saved: &mut Vec<f64>) {
        saved.extend(self.0.iter().skip(lane).step_by(L).map(|number| number.to_f64()));
    }

    fn load_lane(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>) {
        for number in self.0.iter_mut().skip(lane).step_by(L) {
            let [value] = next(saved);
            *number = R::from_f64(value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a lane of a history moves to another lane of another lane count, and the lanes beside it keep theirs.
    #[test]
    fn a_lane_moves_with_its_history() {
        let mut two = History::<2, f64>::of_length(3);
        two.numbers_mut().copy_from_slice(&[1.0, 10.0, 2.0, 20.0, 3.0, 30.0]);
        let mut four = History::<4, f32>::of_length(3);
        let mut saved = Vec::new();
        two.save_lane(1, &mut saved);
        four.load_lane(2, &mut saved.into_iter());
        assert_eq!(four.numbers(), [0., 0., 10., 0., 0., 0., 20., 0., 0., 0., 30., 0.]);
        two.load_lane(0, &mut std::iter::repeat(0.0));
        assert_eq!(two.numbers(), [0.0, 10.0, 0.0, 20.0, 0.0, 30.0]);
    }
}
