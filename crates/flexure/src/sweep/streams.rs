//! Random numbers that are functions of where they are used, and of nothing that was drawn before: what happens to one row of a
//! sweep is the same in any order, on any number of machines.
//!
//! Each is the beginning of a SHA-256, so that other programs can compute them: of the bytes of the purpose, a zero byte, and three
//! numbers of eight bytes, lowest byte first: the seed of the sweep, an index, a column.

/// Random bits for a purpose.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stream {
    pub seed: u64,
    pub purpose: &'static str,
}

impl Stream {
    /// 64 random bits at a place: the first eight bytes of the hash, lowest byte first.
    pub fn bits(self, index: u64, column: u64) -> u64 {
        let mut hash = hmac_sha256::Hash::new();
        hash.update(self.purpose);
        hash.update([0]);
        for number in [self.seed, index, column] {
            hash.update(number.to_le_bytes());
        }
        let [a, b, c, d, e, f, g, h, ..] = hash.finalize();
        u64::from_le_bytes([a, b, c, d, e, f, g, h])
    }

    /// A number from [0, 1) at a place: the upper 53 bits.
    pub fn unit(self, index: u64, column: u64) -> f64 {
        (self.bits(index, column) >> 11) as f64 / 2.0_f64.powi(53)
    }

    /// Where `index` of 0 … `count` − 1 comes in a random order of them, one for each column: four rounds of a Feistel network on
    /// the next power of four, walked until it comes back below `count`.
    pub fn shuffled(self, index: u64, count: u64, column: u64) -> u64 {
        const ROUNDS: u64 = 4;
        let half = count.max(2).next_power_of_two().trailing_zeros().div_ceil(2);
        let mask = (1_u64 << half) - 1;
        let mut place = index;
        loop {
            let (mut left, mut right) = (place >> half, place & mask);
            for round in 0..ROUNDS {
                (left, right) = (right, left ^ (self.bits(right, column * ROUNDS + round) & mask));
            }
            place = left << half | right;
            if place < count {
                return place;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Stream;

    const STREAM: Stream = Stream { seed: 7, purpose: "test" };

    #[test]
    fn an_order_has_each_place_once_and_another_for_each_column() {
        for count in [1, 2, 3, 10, 64, 65, 1000] {
            let order =
                |column| -> Vec<u64> { (0..count).map(|i| STREAM.shuffled(i, count, column)).collect() };
            let mut sorted = order(0);
            sorted.sort_unstable();
            assert_eq!(sorted, (0..count).collect::<Vec<_>>(), "{count}");
            assert!(count < 10 || (order(0) != order(1) && order(0) != sorted), "{count}");
        }
    }

    /// Computed by another program: hashlib.sha256(b"test\0" + struct.pack("<3Q", 7, 1, 2)).
    #[test]
    fn bits_are_those_of_sha_256() {
        assert_eq!(STREAM.bits(1, 2), GOLDEN);
        assert!((STREAM.unit(1, 2) - (GOLDEN >> 11) as f64 / 2.0_f64.powi(53)).abs() < 1e-300);
    }

    const GOLDEN: u64 = 14312878931074674588;
}
