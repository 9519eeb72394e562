//! Random numbers: a stream for each imperfection.

use rand_distr::{Distribution, StandardNormal, StandardUniform};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

/// A stream of random numbers that nobody else draws from.
///
/// It is xoshiro256++, whose state SplitMix64 fills from the FNV-1a hash of the imperfection's kind in UTF-8, its index
/// among those of its kind and the scenario's seed, both as 8 bytes, the lowest first. So adding an imperfection changes no
/// number of another.
#[derive(Clone, Debug)]
pub struct Random(Xoshiro256PlusPlus);

impl Random {
    /// The stream of the imperfection `index` (from 0) of `kind` under `seed`.
    pub fn new(seed: u64, kind: &str, index: u64) -> Self {
        let bytes = kind.bytes().chain(index.to_le_bytes()).chain(seed.to_le_bytes());
        let hash = bytes.fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        Self(Xoshiro256PlusPlus::seed_from_u64(hash))
    }

    /// Uniform in [0, 1).
    pub fn uniform(&mut self) -> f64 {
        StandardUniform.sample(&mut self.0)
    }

    /// Normal, of mean 0 and standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }
}
