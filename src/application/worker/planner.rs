//! Who plans the waves of studies that grow.

use crate::queue::{PlanClaim, Planned, StudyRow};
use std::fmt::Debug;

/// Plans the next wave of a study from the rows that it has.
pub trait Planner: Debug + Sync {
    /// The next wave. It must be the same, whoever plans it: a function of the claim and of the rows.
    fn plan(&self, claim: &PlanClaim, rows: &[StudyRow]) -> Planned;
}
