//! Friction laws.
//!
//! A law gives the friction limit of a slave node, which is its largest friction force. The projection (`project`)
//! is the same for every law. A node whose trial force is within the limit sticks. Any other node slips, and a
//! force of the size of the limit opposes its slip.
//!
//! To add a law, write a file that implements `FrictionLimit` and `LawFormula` for it, and add it to [`Law`], to [`Law::of`] and
//! to `with_law!`. Its name is in [`spec`](crate::spec::FrictionLaw), with what holds whatever its coefficients are, and with its steepest rise. The lanes of
//! a batch have one law with coefficients of their own.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

mod cone;
mod coulomb;
mod exponential;
mod lanes;
mod prakash_clifton;
mod regularised;
mod static_kinetic;
mod table;
mod traits;

pub(in crate::solver) use cone::project;
pub use coulomb::Coulomb;
pub(in crate::solver) use coulomb::Frictionless;
pub use exponential::Exponential;
pub(in crate::solver) use lanes::LawOfLanes;
pub use prakash_clifton::PrakashClifton;
pub use regularised::Regularised;
pub use static_kinetic::StaticKinetic;
pub use table::Table;
use traits::LawFormula;
pub(in crate::solver) use traits::{AtNode, FrictionLimit};

use crate::spec::{Contact, FrictionLaw, Memory};

/// A friction law with the coefficients of one lane.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "a lane has one law, which is copied at most once in a step")]
pub enum Law {
    /// Coulomb's law with a constant coefficient.
    Coulomb(Coulomb),
    /// One coefficient for nodes that begin to slip, and one for nodes that slip.
    StaticKinetic(StaticKinetic),
    /// A coefficient that depends on the slip speed.
    Exponential(Exponential),
    /// Coulomb's law without stick.
    Regularised(Regularised),
    /// Friction that follows the normal force after some slip.
    PrakashClifton(PrakashClifton),
    /// A coefficient that follows a table over the slip speed.
    Table(Table),
}

/// Does the same with a law of any type.
macro_rules! with_law {
    ($law:expr, $own:ident => $call:expr) => {{
        use $crate::solver::interface::law::Law;
        match $law {
            Law::Coulomb($own) => $call,
            Law::StaticKinetic($own) => $call,
            Law::Exponential($own) => $call,
            Law::Regularised($own) => $call,
            Law::PrakashClifton($own) => $call,
            Law::Table($own) => $call,
        }
    }};
}
pub(in crate::solver) use with_law;

impl Law {
    /// Coulomb's law with the coefficient μ ≥ 0.
    pub const fn coulomb(mu: f64) -> Self {
        Self::Coulomb(Coulomb { mu })
    }

    /// The law of a contact. A coefficient that is absent is not a number.
    pub fn of(contact: &Contact) -> Self {
        match contact.law {
            FrictionLaw::Coulomb => Self::Coulomb(Coulomb::of(contact)),
            FrictionLaw::StaticKinetic => Self::StaticKinetic(StaticKinetic::of(contact)),
            FrictionLaw::Exponential => Self::Exponential(Exponential::of(contact)),
            FrictionLaw::Regularised => Self::Regularised(Regularised::of(contact)),
            FrictionLaw::PrakashClifton => Self::PrakashClifton(PrakashClifton::of(contact)),
            FrictionLaw::Table => Self::Table(Table::of(contact)),
        }
    }

    /// Its name in a study.
    pub fn name(&self) -> FrictionLaw {
        with_law!(self, own => name_of(own))
    }

    /// What friction in a step uses of the step before.
    pub fn memory(&self) -> Memory {
        self.name().memory()
    }

    /// The coefficient μ that every law has.
    pub fn mu(&self) -> f64 {
        with_law!(self, own => own.mu())
    }

    /// The same law with another coefficient μ. A static coefficient changes in proportion; without kinetic friction there is no
    /// proportion, and it stays.
    #[must_use]
    pub fn with_mu(&self, mu: f64) -> Self {
        let mut law = *self;
        with_law!(&mut law, own => own.set_mu(mu));
        law
    }

    /// μ(v) of steady slip with the speed v \[m/s\], and μ′(v) \[s/m\]; none if it is μ at every speed.
    pub fn steady(&self, speed_m_s: f64) -> Option<[f64; 2]> {
        with_law!(self, own => own.steady(speed_m_s))
    }

    /// The friction limit \[N\] of one node.
    #[inline(always)]
    pub(in crate::solver) fn limit_n(&self, node: &AtNode<f64>, time_step_s: f64) -> f64 {
        with_law!(self, own => limit_of(own, node, time_step_s))
    }
}

fn name_of<W: LawFormula<N>, const N: usize>(_: &W) -> FrictionLaw {
    W::NAME
}

#[inline(always)]
fn limit_of<W: LawFormula<N>, const N: usize>(law: &W, node: &AtNode<f64>, time_step_s: f64) -> f64 {
    W::limit_n(law.numbers(time_step_s), node)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::MuOfSpeed;

    /// Protects: a law without kinetic friction has finite coefficients at another μ: the static one stays, and elsewhere it
    /// changes in proportion.
    #[test]
    fn a_law_without_kinetic_friction_has_another_mu() {
        let exponential =
            |mu, mu_static| Law::Exponential(Exponential { mu, mu_static, speed_m_s: 0.1, slope_s_m: 0.0 });
        let static_kinetic = |mu, mu_static| Law::StaticKinetic(StaticKinetic { mu, mu_static });
        assert_eq!(exponential(0.0, 0.3).with_mu(0.0), exponential(0.0, 0.3));
        assert_eq!(static_kinetic(0.0, 0.3).with_mu(0.01), static_kinetic(0.01, 0.3));
        assert_eq!(static_kinetic(0.2, 0.3).with_mu(0.4), static_kinetic(0.4, 0.6));
    }

    /// Protects: a table has the same coefficient in a step, in steady slip and in its own curve, at every speed and for every μ.
    #[test]
    fn a_table_is_one_curve() {
        let table = MuOfSpeed(vec![[0.0, 0.5], [0.01, 0.4], [0.05, 0.2], [0.3, 0.25]]);
        let law = |mu| {
            let mu_of_speed = table.clone();
            Law::of(&Contact { law: FrictionLaw::Table, mu, mu_of_speed, ..Contact::default() })
        };
        let time_step_s = 1.0e-7;
        for (mu, law) in [(0.25, law(0.25)), (0.5, law(0.5)), (0.5, law(0.25).with_mu(0.5))] {
            for speed_m_s in [0.0, 0.003, 0.01, 0.02, 0.05, 0.17, 0.3, 5.0] {
                let last_increment_m = [0.6, 0.8].map(|share| share * speed_m_s * time_step_s);
                let node = AtNode {
                    normal_n: 2.0,
                    trial_n: [0.0; 2],
                    stiffness_n_m: 1.0,
                    last_increment_m,
                    last_slipped: 1.0,
                    last_limit_n: 0.0,
                };
                let expected = table.at(speed_m_s).map(|value| value * mu / 0.25);
                let [found, slope_s_m] = law.steady(speed_m_s).unwrap();
                // t has a few roundings, which the slopes of up to 10 parts of μ multiply.
                for (found, expected) in [
                    (found, expected[0]),
                    (slope_s_m, expected[1]),
                    (law.limit_n(&node, time_step_s) / 2.0, expected[0]),
                ] {
                    assert!(
                        (found - expected).abs() < 1.0e-13 * (1.0 + expected.abs()),
                        "{found}, {expected} at {speed_m_s} m/s"
                    );
                }
            }
        }
    }

    /// Protects: every name of a study has the law of that name, with the coefficients of the contact.
    #[test]
    fn a_law_has_the_name_by_which_it_is_chosen() {
        use strum::VariantArray;
        for law in FrictionLaw::VARIANTS {
            let contact = Contact {
                law: *law,
                mu: 0.25,
                mu_static: Some(0.5),
                speed_m_s: Some(0.1),
                length_m: Some(1.0e-6),
                mu_of_speed: MuOfSpeed(vec![[0.0, 0.5], [0.1, 0.25]]),
                ..Contact::default()
            };
            let found = Law::of(&contact);
            assert_eq!((found.name(), found.mu(), found.with_mu(0.5).mu()), (*law, 0.25, 0.5));
            assert_eq!(found.with_mu(0.25), found);
        }
    }
}
