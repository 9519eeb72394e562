//! Triangles of STL files, and fewer of them: for pictures.

use std::collections::HashSet;

/// A triangle, a corner each \[m\].
pub(crate) type Triangle = [[f32; 3]; 3];

/// The triangles of an STL file, of bytes or of text; none if it is none.
pub(crate) fn triangles(bytes: &[u8]) -> Option<Vec<Triangle>> {
    let found = of_bytes(bytes).or_else(|| of_text(std::str::from_utf8(bytes).ok()?))?;
    let is_finite = found.iter().flatten().flatten().all(|x| x.is_finite());
    (is_finite && !found.is_empty()).then_some(found)
}

/// A header of 80 bytes, their number, and 50 bytes a triangle: normal, corners, two bytes more.
fn of_bytes(bytes: &[u8]) -> Option<Vec<Triangle>> {
    let (count, rest) = bytes.get(80..)?.split_first_chunk::<4>()?;
    let count = u32::from_le_bytes(*count) as usize;
    if rest.len() != count.checked_mul(50)? {
        return None;
    }
    let corner = |bytes: &[u8]| {
        let number = |k: usize| bytes[4 * k..4 * k + 4].try_into().map_or(f32::NAN, f32::from_le_bytes);
        [number(0), number(1), number(2)]
    };
    Some(
        rest.chunks_exact(50)
            .map(|facet| [corner(&facet[12..]), corner(&facet[24..]), corner(&facet[36..])])
            .collect(),
    )
}

/// `vertex x y z`, three to a facet.
fn of_text(text: &str) -> Option<Vec<Triangle>> {
    if !text.trim_start().starts_with("solid") {
        return None;
    }
    let corners: Vec<[f32; 3]> = text
        .lines()
        .filter_map(|line| line.trim().strip_prefix("vertex"))
        .map(|rest| {
            let numbers: Vec<f32> = rest.split_whitespace().map_while(|word| word.parse().ok()).collect();
            numbers.try_into().ok()
        })
        .collect::<Option<_>>()?;
    corners
        .len()
        .is_multiple_of(3)
        .then(|| corners.chunks_exact(3).map(|three| [three[0], three[1], three[2]]).collect())
}

/// The triangles with their corners on a grid of `cells` along the longest edge of what they fill, without those that vanish there or come
/// twice.
pub(crate) fn coarser(triangles: &[Triangle], cells: f32) -> Vec<Triangle> {
    let corners = || triangles.iter().flatten();
    let end = |k: usize, of: fn(f32, f32) -> f32, from: f32| corners().map(|corner| corner[k]).fold(from, of);
    let low: [f32; 3] = std::array::from_fn(|k| end(k, f32::min, f32::INFINITY));
    let size = (0..3).map(|k| end(k, f32::max, f32::NEG_INFINITY) - low[k]).fold(0.0, f32::max);
    if size <= 0.0 {
        return Vec::new();
    }
    let step = size / cells;
    let mut seen = HashSet::new();
    let mut kept = Vec::new();
    for triangle in triangles {
        #[expect(clippy::cast_possible_truncation, reason = "a number of cells")]
        let cell = |corner: &[f32; 3]| -> [i32; 3] {
            std::array::from_fn(|k| ((corner[k] - low[k]) / step).round() as i32)
        };
        let [a, b, c] = triangle.each_ref().map(cell);
        if a != b && b != c && c != a && seen.insert([a, b, c]) {
            let place =
                |cell: [i32; 3]| -> [f32; 3] { std::array::from_fn(|k| low[k] + step * cell[k] as f32) };
            kept.push([a, b, c].map(place));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::{Triangle, coarser, triangles};

    const ONE: Triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]];

    fn file(triangles: &[Triangle]) -> Vec<u8> {
        let mut bytes = vec![b's'; 80];
        bytes.extend(u32::try_from(triangles.len()).unwrap().to_le_bytes());
        for triangle in triangles {
            bytes.extend([0; 12]);
            bytes.extend(triangle.iter().flatten().flat_map(|x| x.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[test]
    fn both_kinds_are_read() {
        assert_eq!(triangles(&file(&[ONE, ONE])), Some(vec![ONE, ONE]));
        let text = "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n vertex 1 0 0\nvertex 0 1 5e-1\nendloop\nendfacet\nendsolid";
        assert_eq!(triangles(text.as_bytes()), Some(vec![ONE]));
    }

    #[test]
    fn what_is_no_stl_is_none() {
        let whole = file(&[ONE]);
        let infinite = file(&[[[f32::INFINITY; 3]; 3]]);
        for bytes in [
            &whole[..whole.len() - 1],
            &whole[..83],
            &[],
            b"solid\nvertex 1 2\n",
            b"<COLLADA/>",
            &file(&[]),
            &infinite,
        ] {
            assert_eq!(triangles(bytes), None);
        }
        let mut huge = vec![0; 84];
        huge[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
        assert_eq!(triangles(&huge), None);
    }

    #[test]
    fn coarser_is_fewer_and_where_it_was() {
        // A strip of thin triangles, two to a step.
        let strip: Vec<Triangle> = (0u8..200)
            .map(|k| {
                let x = 0.005 * f32::from(k);
                [[x, 0.0, 0.0], [x + 0.005, 0.0, 0.0], [x, 0.2, 0.0]]
            })
            .collect();
        let kept = coarser(&strip, 10.0);
        assert!(!kept.is_empty() && kept.len() <= 20, "{}", kept.len());
        assert!(
            kept.iter().flatten().all(|[x, y, _]| (-0.06..=1.06).contains(x) && (-0.06..=0.26).contains(y))
        );
        assert_eq!(coarser(&[[[1.0; 3]; 3]], 10.0), Vec::<Triangle>::new());
    }
}
