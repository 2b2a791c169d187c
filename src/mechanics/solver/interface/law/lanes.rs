//! A law in all lanes.

use super::traits::LawFormula;
use super::{Law, with_law};
use crate::solver::field::{WIDTH, in_slots_of};
use crate::solver::number::Number;
use std::any::Any;
use std::marker::PhantomData;

/// The law `W` of all lanes: its numbers for a step, each with the lanes in the slots of a vector.
#[derive(Debug)]
pub(in crate::solver) struct LawOfLanes<W, R: Number, const N: usize> {
    pub rows: [R::Row; N],
    law: PhantomData<W>,
}

impl<W, R: Number> LawOfLanes<W, R, 0> {
    /// A law without numbers.
    pub const NONE: Self = Self { rows: [], law: PhantomData };
}

impl<W: LawFormula<N> + 'static, R: Number, const N: usize> LawOfLanes<W, R, N> {
    /// Lanes of the law that one of them has. The [idle](Law::is_idle) ones may have another: their load is zero, so that any
    /// numbers serve.
    pub fn new(_of_one: &W, lanes: &[&Law], time_step_s: f64) -> Self {
        let mut numbers = [[0.0; WIDTH]; N];
        for (lane, law) in lanes.iter().enumerate() {
            let own = with_law!(law, own => (own as &dyn Any).downcast_ref::<W>());
            debug_assert!(own.is_some() || law.is_idle(), "lanes of one law: {lanes:?}");
            if let Some(own) = own {
                for (row, number) in numbers.iter_mut().zip(own.numbers(time_step_s)) {
                    row[lane] = number;
                }
            }
        }
        Self { rows: numbers.map(|row| in_slots_of::<R>(&row[..lanes.len()])), law: PhantomData }
    }
}

impl Law {
    /// Whether it is Coulomb's law with μ = 0, as a lane without a job has it.
    pub(in crate::solver) fn is_idle(&self) -> bool {
        *self == Self::coulomb(0.0)
    }
}
