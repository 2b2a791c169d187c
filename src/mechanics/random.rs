//! Random numbers that are the same on every machine.

/// The step of the generator's state: 2⁶⁴ over the golden ratio.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

/// The generator `SplitMix64` (Steele, Lea and Flood 2014) with its state.
pub struct SplitMix64(u64);

impl SplitMix64 {
    /// The sequence of a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The sequence of a seed from its number `index` on.
    pub fn from(seed: u64, index: u64) -> Self {
        Self(seed.wrapping_add(index.wrapping_mul(STEP)))
    }

    /// 64 random bits.
    pub fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(STEP);
        mix(self.0)
    }

    /// A number in the interval [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.word() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A whole number below `count`. Its bias, count/2⁶⁴, does not matter.
    pub fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.word()) * count.max(1) as u128) >> 64) as usize
    }
}

/// Mixes bits so that each of them changes about half of all others.
pub fn mix(mut bits: u64) -> u64 {
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: the generator is the published one, whose first numbers for the seed 1234567 are those of its reference program
    /// (Vigna, splitmix64.c), and a later start continues the same sequence.
    #[test]
    fn the_sequence_is_the_published_one() {
        let mut random = SplitMix64::new(1_234_567);
        let first = [random.word(), random.word(), random.word()];
        assert_eq!(first, [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423]);
        assert_eq!(SplitMix64::from(1_234_567, 2).word(), first[2]);
        assert!((0..1000).all(|_| (0.0..1.0).contains(&random.unit()) && random.below(7) < 7));
    }
}
