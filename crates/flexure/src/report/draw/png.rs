//! Pixels as a PNG file (ISO/IEC 15948).

use miniz_oxide::deflate::compress_to_vec_zlib;

/// How hard the compression tries, from 0 to 10.
const LEVEL: u8 = 6;

/// A picture of `width` by `height` pixels, a byte each of red, green and blue, in rows from the top.
pub(crate) fn encode(width: u32, height: u32, rgb: &[u8]) -> Vec<u8> {
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    let [w, h] = [width, height].map(u32::to_be_bytes);
    // Eight bits a colour, red, green and blue, not interlaced.
    chunk(&mut file, *b"IHDR", &[&w[..], &h, &[8, 2, 0, 0, 0]].concat());
    chunk(&mut file, *b"IDAT", &compress_to_vec_zlib(&filtered(3 * width as usize, rgb), LEVEL));
    chunk(&mut file, *b"IEND", &[]);
    file
}

/// Each row as its difference from the one above, filter 2: figures repeat downwards.
fn filtered(row: usize, rgb: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(rgb.len() + rgb.len() / row);
    let blank = vec![0; row];
    for (above, line) in std::iter::once(&blank[..]).chain(rgb.chunks_exact(row)).zip(rgb.chunks_exact(row)) {
        bytes.push(2);
        bytes.extend(line.iter().zip(above).map(|(byte, above)| byte.wrapping_sub(*above)));
    }
    bytes
}

/// Length, name, data and their check sum.
fn chunk(file: &mut Vec<u8>, name: [u8; 4], data: &[u8]) {
    let length = u32::try_from(data.len()).expect("a picture of less than 4 GiB");
    file.extend(length.to_be_bytes());
    let start = file.len();
    file.extend(name);
    file.extend(data);
    let sum = checksum(&file[start..]);
    file.extend(sum.to_be_bytes());
}

/// CRC-32.
fn checksum(bytes: &[u8]) -> u32 {
    let bit = |sum: u32, _| (sum >> 1) ^ (0xedb8_8320 & (sum & 1).wrapping_neg());
    !bytes.iter().fold(!0, |sum, byte| (0..8).fold(sum ^ u32::from(*byte), bit))
}

#[cfg(test)]
mod tests {
    use super::{checksum, filtered};

    /// The check value of the catalogue of CRC algorithms.
    #[test]
    fn the_check_sum_is_crc_32() {
        assert_eq!(checksum(b"123456789"), 0xcbf4_3926);
    }

    #[test]
    fn rows_add_up() {
        let rgb: Vec<u8> = (0..60u8).map(|k| k.wrapping_mul(k)).collect();
        let mut above = vec![0u8; 12];
        let mut restored = Vec::new();
        for line in filtered(12, &rgb).chunks_exact(13) {
            assert_eq!(line[0], 2);
            above = line[1..].iter().zip(&above).map(|(a, b)| a.wrapping_add(*b)).collect();
            restored.extend(above.iter().copied());
        }
        assert_eq!(restored, rgb);
    }
}
