//! The contact phases of a node, and the instants at which they change.

use crate::solver::interface::ContactState;

/// An interval of time in one contact state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Phase {
    /// The state.
    pub state: ContactState,
    /// Time \[s\] of its first step.
    pub start_s: f64,
    /// Time \[s\] of the first step after it.
    pub end_s: f64,
}

impl Phase {
    /// Duration \[s\].
    pub fn duration_s(&self) -> f64 {
        self.end_s - self.start_s
    }
}

/// The phases of consecutive steps, given as time t_n [s] and state. The last phase ends at `end_s` [s].
pub fn phases(steps: impl Iterator<Item = (f64, ContactState)>, end_s: f64) -> Vec<Phase> {
    let mut phases: Vec<Phase> = Vec::new();
    for (time_s, state) in steps {
        match phases.last_mut() {
            Some(last) if last.state == state => {}
            last => {
                if let Some(last) = last {
                    last.end_s = time_s;
                }
                phases.push(Phase { state, start_s: time_s, end_s });
            }
        }
    }
    phases
}

/// The instants of a cycle of a node, as in the paper's Figure 4. An instant is none if the node does not have its phase.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Instants {
    /// t_A \[s\]: contact begins, at the end of the longest separation.
    pub contact_s: Option<f64>,
    /// t_B \[s\]: stick begins.
    pub stick_s: Option<f64>,
    /// t_C \[s\]: the normal stress is largest.
    pub peak_s: f64,
    /// t_D \[s\]: stick ends.
    pub slip_s: Option<f64>,
    /// t_E \[s\]: contact ends, at the start of the next longest separation.
    pub separation_s: Option<f64>,
    /// t_F \[s\]: that separation ends.
    pub end_s: Option<f64>,
}

impl Instants {
    /// Letter and time \[s\] of the instants that exist, in the order of the letters.
    pub fn named(&self) -> Vec<(char, f64)> {
        let all = [
            ('A', self.contact_s),
            ('B', self.stick_s),
            ('C', Some(self.peak_s)),
            ('D', self.slip_s),
            ('E', self.separation_s),
            ('F', self.end_s),
        ];
        all.into_iter().filter_map(|(letter, time_s)| Some((letter, time_s?))).collect()
    }

    /// Start and end \[s\] of the time in which they are shown: from a twentieth of a period before the first to a twentieth
    /// after the last. For a node that does not separate, it is the period around the peak.
    pub fn span_s(&self, period_s: f64) -> [f64; 2] {
        match (self.contact_s, self.end_s) {
            (Some(from_s), Some(to_s)) => [from_s - period_s / 20.0, to_s + period_s / 20.0],
            _ => [self.peak_s - period_s / 2.0, self.peak_s + period_s / 2.0],
        }
    }

    /// Finds the instants of the cycle that starts in the period from `from_s` on.
    ///
    /// The cycle lasts from the end of a separation to the end of the next one. At a node that does not separate, it lasts
    /// from the start of a slip phase to the start of the next one. Phases of a few steps (a node that touches before it
    /// closes, or that slips for a moment while it sticks) are ignored: of the separations, or slip phases, that start in
    /// a period, the longest one is taken. Stick lasts from the start of the first to the end of the last phase in which
    /// the node sticks for at least a twentieth of a period. The first of `phases` is not taken as a start, because it
    /// may have started before the recording. `stress` has the time \[s\] and the normal stress \[Pa\] of every step.
    ///
    /// Returns none if there is no step in the cycle.
    pub fn find(phases: &[Phase], stress: &[(f64, f64)], from_s: f64, period_s: f64) -> Option<Self> {
        let starting = |state: ContactState, [from_s, to_s]: [f64; 2]| {
            let of_state = phases.iter().skip(1).filter(move |phase| phase.state == state);
            of_state.filter(move |phase| phase.start_s >= from_s && phase.start_s < to_s)
        };
        let longest = |state: ContactState, span_s: [f64; 2]| {
            starting(state, span_s).max_by(|a, b| a.duration_s().total_cmp(&b.duration_s()))
        };
        let period = [from_s, from_s + period_s];
        let before = longest(ContactState::Separated, period);
        let after = before.and_then(|phase| {
            let begin_s = phase.start_s + period_s / 2.0;
            longest(ContactState::Separated, [begin_s, begin_s + period_s])
        });
        let cycle = if let (Some(before), Some(after)) = (before, after) {
            [before.end_s, after.start_s]
        } else {
            let start_s = longest(ContactState::Slip, period).map_or(from_s, |phase| phase.start_s);
            [start_s, start_s + period_s]
        };
        let within = stress.iter().filter(|(time_s, _)| *time_s >= cycle[0] && *time_s < cycle[1]);
        let (peak_s, _) = within.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let mut sticks =
            starting(ContactState::Stick, cycle).filter(|phase| phase.duration_s() >= period_s / 20.0);
        let first = sticks.next();
        let last = sticks.next_back().or(first);
        let separates = before.is_some() && after.is_some();
        Some(Self {
            contact_s: before.filter(|_| separates).map(|phase| phase.end_s),
            stick_s: first.map(|phase| phase.start_s),
            peak_s: *peak_s,
            slip_s: last.map(|phase| phase.end_s),
            separation_s: after.map(|phase| phase.start_s),
            end_s: after.map(|phase| phase.end_s),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ContactState::{Separated, Slip, Stick};

    /// Steps of 1 s: `cycle` again and again.
    fn steps(cycle: &[(ContactState, usize)], times: usize) -> Vec<(f64, ContactState)> {
        let once = cycle.iter().flat_map(|&(state, count)| std::iter::repeat_n(state, count));
        let all: Vec<_> = once.collect::<Vec<_>>().repeat(times);
        all.into_iter().enumerate().map(|(n, state)| (n as f64, state)).collect()
    }

    fn found(cycle: &[(ContactState, usize)], peak: usize) -> Instants {
        let period: usize = cycle.iter().map(|(_, count)| count).sum();
        let steps = steps(cycle, 4);
        let stress: Vec<_> =
            steps.iter().map(|&(t, _)| (t, -((t as usize % period) as f64 - peak as f64).abs())).collect();
        let end_s = steps.len() as f64;
        let phases = phases(steps.into_iter(), end_s);
        Instants::find(&phases, &stress, 0.0, period as f64).unwrap()
    }

    /// Protects: phases start and end where the state changes, and none is lost.
    #[test]
    fn phases_follow_each_other() {
        let found = phases(steps(&[(Slip, 2), (Stick, 3), (Separated, 1)], 2).into_iter(), 12.0);
        let expected = [
            (Slip, 0, 2),
            (Stick, 2, 5),
            (Separated, 5, 6),
            (Slip, 6, 8),
            (Stick, 8, 11),
            (Separated, 11, 12),
        ];
        let expected: Vec<_> = expected
            .map(|(state, start, end)| Phase { state, start_s: f64::from(start), end_s: f64::from(end) })
            .into();
        assert_eq!(found, expected);
    }

    /// Protects: the instants of the paper's cycle are found in their order, for any start of the search, even if the node
    /// touches for a step before it closes and slips for a step while it sticks.
    #[test]
    fn the_papers_cycle_has_six_instants() {
        let cycle = [
            (Slip, 4),
            (Stick, 6),
            (Slip, 1),
            (Stick, 2),
            (Slip, 5),
            (Separated, 8),
            (Slip, 1),
            (Separated, 2),
        ];
        let instants = found(&cycle, 9);
        // The first separation that is long is from 18 to 26; the next one from 47.
        let times: Vec<_> = instants.named();
        assert_eq!(times, [('A', 26.0), ('B', 33.0), ('C', 38.0), ('D', 42.0), ('E', 47.0), ('F', 55.0)]);
        assert!(times.windows(2).all(|pair| pair[0].1 < pair[1].1));
    }

    /// Protects: there are no instants of phases that do not exist.
    #[test]
    fn other_regimes_have_fewer_instants() {
        let stick_slip = found(&[(Slip, 5), (Stick, 9)], 7);
        assert_eq!(stick_slip.named(), [('B', 5.0), ('C', 7.0), ('D', 14.0)]);
        // The recording may start anywhere in the cycle: here it starts in a stick phase.
        let from_stick = found(&[(Stick, 4), (Slip, 5), (Stick, 5)], 11);
        assert_eq!(from_stick.named(), [('B', 9.0), ('C', 11.0), ('D', 18.0)]);
        let slip_separation = found(&[(Slip, 5), (Separated, 9)], 2);
        assert_eq!(slip_separation.named(), [('A', 14.0), ('C', 16.0), ('E', 19.0), ('F', 28.0)]);
        let sliding = found(&[(Slip, 10)], 3);
        assert_eq!(sliding.named(), [('C', 3.0)]);
    }
}
