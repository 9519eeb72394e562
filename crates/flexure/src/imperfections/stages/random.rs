//! Random numbers: a stream for each imperfection.

use std::convert::Infallible;

use flexure_core::memory::{Memory, Port};
use rand_distr::{Distribution, StandardNormal, StandardUniform};
use rand_xoshiro::rand_core::{TryRng, utils};

/// A stream of random numbers that nobody else draws from.
///
/// It is xoshiro256++ (Blackman & Vigna, *ACM Transactions on Mathematical Software* 47, 2021), whose state SplitMix64 fills
/// from the FNV-1a hash of the imperfection's kind in UTF-8, its index among those of its kind and the scenario's seed, both as
/// 8 bytes, the lowest first. So adding an imperfection changes no number of another. It is spelt out here because its state
/// is saved with the loop.
#[derive(Clone, Debug)]
pub struct Random {
    state: [u64; 4],
}

impl Random {
    /// The stream of the imperfection `index` (from 0) of `kind` under `seed`.
    pub fn new(seed: u64, kind: &str, index: u64) -> Self {
        let bytes = kind.bytes().chain(index.to_le_bytes()).chain(seed.to_le_bytes());
        let hash = bytes.fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        Self::seeded(hash)
    }

    /// With the next four numbers of SplitMix64 after `seed` as state.
    fn seeded(mut seed: u64) -> Self {
        let state = std::array::from_fn(|_| {
            seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mixed = (seed ^ (seed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            mixed ^ (mixed >> 31)
        });
        Self { state }
    }

    fn next(&mut self) -> u64 {
        let [a, b, c, d] = self.state;
        let (c, d) = (c ^ a, d ^ b);
        let number = a.wrapping_add(self.state[3]).rotate_left(23).wrapping_add(a);
        self.state = [a ^ d, b ^ c, c ^ (b << 17), d.rotate_left(45)];
        number
    }

    /// Uniform in [0, 1).
    pub fn uniform(&mut self) -> f64 {
        StandardUniform.sample(self)
    }

    /// Normal, of mean 0 and standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        StandardNormal.sample(self)
    }
}

impl TryRng for Random {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        // The upper bits are the better ones.
        self.try_next_u64().map(|number| (number >> 32) as u32)
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        Ok(self.next())
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        utils::fill_bytes_via_next_word(bytes, || self.try_next_u64())
    }
}

/// The four words of the state.
impl Memory<f64> for Random {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        for (name, word) in ["a", "b", "c", "d"].into_iter().zip(&mut self.state) {
            port.long(name, word);
        }
    }
}

#[cfg(test)]
mod tests {
    use rand_xoshiro::Xoshiro256PlusPlus;
    use rand_xoshiro::rand_core::{Rng, SeedableRng};

    use super::Random;

    /// The generator is that of the crate `rand_xoshiro`, which is tested against its authors' program.
    #[test]
    fn numbers_are_those_of_xoshiro256_plus_plus() {
        for seed in [0, 1, 42, 0xcbf2_9ce4_8422_2325, u64::MAX] {
            let (mut own, mut other) = (Random::seeded(seed), Xoshiro256PlusPlus::seed_from_u64(seed));
            for _ in 0..1000 {
                assert_eq!(own.next(), other.next_u64());
            }
        }
    }
}
