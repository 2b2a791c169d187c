//! The limit of friction of a node, as a coefficient.

use crate::analysis::sample::NodeSample;
use crate::spec::{Contact, JobSpec, Memory};

/// The largest friction force over the normal force; 0 without contact. Of Coulomb's law it is μ, without the rounding of a
/// product and a quotient.
pub fn limit(spec: &JobSpec, node: &NodeSample) -> f64 {
    let [_, _, normal_n] = node.force_n;
    match &spec.scene.contact {
        Contact { law, mu, .. } if law.is_always_mu() => *mu,
        _ if normal_n > 0.0 => node.limit_n / normal_n,
        _ => 0.0,
    }
}

/// The largest limit among samples, and at least μ.
pub fn largest<'a>(spec: &JobSpec, nodes: impl Iterator<Item = &'a NodeSample>) -> f64 {
    let mu = spec.scene.contact.mu;
    match spec.scene.contact.law.memory() {
        // A limit with a state can be far above the normal force when a node leaves.
        Memory::Limit => nodes.map(NodeSample::equivalent_friction).fold(mu, f64::max).min(4.0 * mu),
        Memory::None | Memory::Slip => nodes.map(|node| limit(spec, node)).fold(mu, f64::max),
    }
}

/// What a node that slips has.
pub fn in_words(contact: &Contact) -> String {
    let Contact { law, mu, .. } = contact;
    if law.is_always_mu() { mu.to_string() } else { format!("the limit of the law {}", law.name()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::FrictionLaw;

    /// Protects: the limit is that of the law that the job has, and the axis has room for it.
    #[test]
    fn the_limit_is_that_of_the_law() {
        let mut spec = JobSpec::default();
        let node = NodeSample { force_n: [0.0, 1.0, 4.0], limit_n: 2.0, ..NodeSample::default() };
        let open = NodeSample::default();
        assert_eq!((limit(&spec, &node), largest(&spec, [node].iter())), (0.4, 0.4));
        assert_eq!(in_words(&spec.scene.contact), "0.4");
        spec.scene.contact.law = FrictionLaw::StaticKinetic;
        assert_eq!((limit(&spec, &node), limit(&spec, &open)), (0.5, 0.0));
        assert_eq!(largest(&spec, [open, node].iter()), 0.5);
        assert_eq!(largest(&spec, [open].iter()), 0.4);
        assert!(in_words(&spec.scene.contact).contains("static_kinetic"));
    }
}
