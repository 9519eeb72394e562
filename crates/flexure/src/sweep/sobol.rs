//! Points that fill the unit cube evenly: Sobol's sequence, each coordinate scrambled after Owen, any point by its index.
//!
//! Directions after S. Joe and F. Y. Kuo, Constructing Sobol sequences with better two-dimensional projections, SIAM J. Sci. Comput. 30
//! (2008): their table `new-joe-kuo-6.21201`. Scrambling by hashing after B. Burley, Practical Hash-based Owen Scrambling, J. Comput.
//! Graph. Tech. 9(4) (2020), with the hash of N. Vegdahl that its section 5 points to.

/// Dimensions that there are directions for.
pub(super) const DIMENSIONS: usize = DIRECTIONS.len() + 1;

/// Points that there are.
pub(super) const POINTS: u64 = 1 << 32;

/// Coordinate `dimension` of the point `index`, in units of 2⁻³².
fn plain(index: u32, dimension: usize) -> u32 {
    let mut directions = [0_u32; 32];
    match dimension.checked_sub(1).and_then(|row| DIRECTIONS.get(row)) {
        None => (0..32).for_each(|bit| directions[bit] = 1 << (31 - bit)),
        Some((polynomial, first)) => {
            let degree = first.len();
            for bit in 0..32 {
                directions[bit] = if bit < degree {
                    first[bit] << (31 - bit)
                } else {
                    let mut direction = directions[bit - degree] ^ (directions[bit - degree] >> degree);
                    for k in 1..degree {
                        if polynomial >> (degree - 1 - k) & 1 == 1 {
                            direction ^= directions[bit - k];
                        }
                    }
                    direction
                };
            }
        }
    }
    let chosen = directions.iter().enumerate().filter(|(bit, _)| index >> bit & 1 == 1);
    chosen.fold(0, |sum, (_, direction)| sum ^ direction)
}

/// A random order of the halves, of the halves of each half, and so on: Owen's scrambling, by a hash that carries upwards only.
fn scrambled(x: u32, seed: u32) -> u32 {
    let mut x = x.reverse_bits();
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul(seed >> 16 | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x.reverse_bits()
}

/// Coordinate `dimension` of the point `index`, in (0, 1), scrambled by `seed`: the middle of one of 2³² parts.
pub(super) fn coordinate(index: u32, dimension: usize, seed: u32) -> f64 {
    (f64::from(scrambled(plain(index, dimension), seed)) + 0.5) / 2.0_f64.powi(32)
}

/// For each dimension after the first the inner coefficients of its primitive polynomial, as bits, and its first directions.
const DIRECTIONS: [(u32, &[u32]); 63] = [
    (0, &[1]),
    (1, &[1, 3]),
    (1, &[1, 3, 1]),
    (2, &[1, 1, 1]),
    (1, &[1, 1, 3, 3]),
    (4, &[1, 3, 5, 13]),
    (2, &[1, 1, 5, 5, 17]),
    (4, &[1, 1, 5, 5, 5]),
    (7, &[1, 1, 7, 11, 19]),
    (11, &[1, 1, 5, 1, 1]),
    (13, &[1, 1, 1, 3, 11]),
    (14, &[1, 3, 5, 5, 31]),
    (1, &[1, 3, 3, 9, 7, 49]),
    (13, &[1, 1, 1, 15, 21, 21]),
    (16, &[1, 3, 1, 13, 27, 49]),
    (19, &[1, 1, 1, 15, 7, 5]),
    (22, &[1, 3, 1, 15, 13, 25]),
    (25, &[1, 1, 5, 5, 19, 61]),
    (1, &[1, 3, 7, 11, 23, 15, 103]),
    (4, &[1, 3, 7, 13, 13, 15, 69]),
    (7, &[1, 1, 3, 13, 7, 35, 63]),
    (8, &[1, 3, 5, 9, 1, 25, 53]),
    (14, &[1, 3, 1, 13, 9, 35, 107]),
    (19, &[1, 3, 1, 5, 27, 61, 31]),
    (21, &[1, 1, 5, 11, 19, 41, 61]),
    (28, &[1, 3, 5, 3, 3, 13, 69]),
    (31, &[1, 1, 7, 13, 1, 19, 1]),
    (32, &[1, 3, 7, 5, 13, 19, 59]),
    (37, &[1, 1, 3, 9, 25, 29, 41]),
    (41, &[1, 3, 5, 13, 23, 1, 55]),
    (42, &[1, 3, 7, 3, 13, 59, 17]),
    (50, &[1, 3, 1, 3, 5, 53, 69]),
    (55, &[1, 1, 5, 5, 23, 33, 13]),
    (56, &[1, 1, 7, 7, 1, 61, 123]),
    (59, &[1, 1, 7, 9, 13, 61, 49]),
    (62, &[1, 3, 3, 5, 3, 55, 33]),
    (14, &[1, 3, 1, 15, 31, 13, 49, 245]),
    (21, &[1, 3, 5, 15, 31, 59, 63, 97]),
    (22, &[1, 3, 1, 11, 11, 11, 77, 249]),
    (38, &[1, 3, 1, 11, 27, 43, 71, 9]),
    (47, &[1, 1, 7, 15, 21, 11, 81, 45]),
    (49, &[1, 3, 7, 3, 25, 31, 65, 79]),
    (50, &[1, 3, 1, 1, 19, 11, 3, 205]),
    (52, &[1, 1, 5, 9, 19, 21, 29, 157]),
    (56, &[1, 3, 7, 11, 1, 33, 89, 185]),
    (67, &[1, 3, 3, 3, 15, 9, 79, 71]),
    (70, &[1, 3, 7, 11, 15, 39, 119, 27]),
    (84, &[1, 1, 3, 1, 11, 31, 97, 225]),
    (97, &[1, 1, 1, 3, 23, 43, 57, 177]),
    (103, &[1, 3, 7, 7, 17, 17, 37, 71]),
    (115, &[1, 3, 1, 5, 27, 63, 123, 213]),
    (122, &[1, 1, 3, 5, 11, 43, 53, 133]),
    (8, &[1, 3, 5, 5, 29, 17, 47, 173, 479]),
    (13, &[1, 3, 3, 11, 3, 1, 109, 9, 69]),
    (16, &[1, 1, 1, 5, 17, 39, 23, 5, 343]),
    (22, &[1, 3, 1, 5, 25, 15, 31, 103, 499]),
    (25, &[1, 1, 1, 11, 11, 17, 63, 105, 183]),
    (44, &[1, 1, 5, 11, 9, 29, 97, 231, 363]),
    (47, &[1, 1, 5, 15, 19, 45, 41, 7, 383]),
    (52, &[1, 3, 7, 7, 31, 19, 83, 137, 221]),
    (55, &[1, 1, 1, 3, 23, 15, 111, 223, 83]),
    (59, &[1, 1, 5, 13, 31, 15, 55, 25, 161]),
    (62, &[1, 1, 3, 13, 25, 47, 39, 87, 257]),
];

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::{DIMENSIONS, coordinate, plain, scrambled};

    /// Point i of scipy.stats.qmc.Sobol(64, scramble=False, bits=32), which runs through the points in the order of Gray's code.
    const SCIPY: [(u32, usize, f64); 6] = [
        (63, 63, 0.734375),
        (37, 5, 0.296875),
        (50, 20, 0.671875),
        (1, 1, 0.5),
        (5, 40, 0.375),
        (62, 33, 0.015625),
    ];

    #[test]
    fn points_are_those_of_scipy() {
        for (i, dimension, expected) in SCIPY {
            let found = f64::from(plain(i ^ i >> 1, dimension)) / 2.0_f64.powi(32);
            assert!((found - expected).abs() < 1e-300, "{i} {dimension}: {found}, not {expected}");
        }
    }

    /// What a Sobol sequence is made for, and scrambling keeps: one of the first 2ᵐ points in each of 2ᵐ equal parts of each axis, and
    /// in each cell of any such division of the first two axes.
    #[test]
    fn points_fill_evenly() {
        let seeds = [0x1234_5678, 0x9abc_def1];
        // The upper bits say in which part a point lies: these are the same numbers as `coordinate` has.
        let part = |i, dimension: usize, bits: u32| {
            u64::from(scrambled(plain(i, dimension), seeds[dimension % 2])) >> (32 - bits)
        };
        for dimension in 0..DIMENSIONS {
            let parts: BTreeSet<u64> = (0..256).map(|i| part(i, dimension, 8)).collect();
            assert_eq!(parts.len(), 256, "dimension {dimension}");
        }
        for wide in 0..=8 {
            let cells: BTreeSet<[u64; 2]> =
                (0..256).map(|i| [part(i, 0, wide), part(i, 1, 8 - wide)]).collect();
            assert_eq!(cells.len(), 256, "{wide}");
        }
    }

    #[test]
    fn seeds_give_other_points_in_the_same_parts() {
        let points = |seed| -> Vec<f64> { (0..16).map(|i| coordinate(i, 3, seed)).collect() };
        assert_ne!(points(1), points(2));
    }
}
