//! Numbers that files of proofs pack, read and written without the library that the program takes for it.

use serde_json::Value;

/// The numbers that `text` packs.
pub fn numbers(text: &Value) -> Vec<f64> {
    let bytes = base64(text.as_str().expect("a text"));
    bytes.chunks_exact(8).map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap())).collect()
}

const DIGITS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// RFC 4648, independent of the library that the file is written with.
fn base64(text: &str) -> Vec<u8> {
    let mut bits = 0_u32;
    let mut count = 0;
    let mut bytes = Vec::new();
    for digit in text.bytes().filter(|&digit| digit != b'=') {
        let place = DIGITS.iter().position(|&known| known == digit).expect("base64");
        bits = bits << 6 | u32::try_from(place).expect("of 64");
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count & 0xff) as u8);
        }
    }
    bytes
}

/// What packs `numbers`.
pub fn text_of(numbers: &[f64]) -> Value {
    let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    let digits = |three: &[u8]| {
        let bits =
            three.iter().fold(0_u32, |bits, &byte| bits << 8 | u32::from(byte)) << (8 * (3 - three.len()));
        let digit = move |i: usize| {
            if i <= three.len() { DIGITS[(bits >> (18 - 6 * i) & 63) as usize] } else { b'=' }
        };
        (0..4).map(digit).map(char::from).collect::<String>()
    };
    Value::from(bytes.chunks(3).map(digits).collect::<String>())
}
