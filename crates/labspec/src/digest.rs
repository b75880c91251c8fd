//! SHA-256, after FIPS 180-4: content by which results of earlier checks are known again.

/// The first 32 bits of the fractional parts of the cube roots of the first 64 primes.
const K: [u32; 64] = constants();
/// The same of the square roots of the first eight.
const START: [u32; 8] =
    [0x6a09_e667, 0xbb67_ae85, 0x3c6e_f372, 0xa54f_f53a, 0x510e_527f, 0x9b05_688c, 0x1f83_d9ab, 0x5be0_cd19];

/// Bits 32 to 63 behind the point of the cube root of every prime: the largest `x` with `x³ ≤ p·2⁹⁶`, without its whole part.
const fn constants() -> [u32; 64] {
    let mut all = [0; 64];
    let (mut count, mut p) = (0, 2_u128);
    while count < 64 {
        let mut divisor = 2;
        while divisor * divisor <= p && p % divisor != 0 {
            divisor += 1;
        }
        if divisor * divisor > p {
            // Cube roots up to 311 are below 7: 35 bits hold one with its 32 behind the point.
            let (mut root, mut bit) = (0_u128, 1_u128 << 34);
            while bit > 0 {
                let more = root | bit;
                if more * more * more <= p << 96 {
                    root = more;
                }
                bit >>= 1;
            }
            all[count] = root as u32;
            count += 1;
        }
        p += 1;
    }
    all
}

/// The digest of bytes, as 64 hexadecimal digits.
pub(crate) fn hex(bytes: &[u8]) -> String {
    let mut state = START;
    let (blocks, rest) = bytes.as_chunks::<64>();
    blocks.iter().for_each(|block| stir(&mut state, block));
    // One bit, zeros, and the length in bits at the end of a block.
    let mut tail = rest.to_vec();
    tail.push(0x80);
    while tail.len() % 64 != 56 {
        tail.push(0);
    }
    tail.extend((8 * bytes.len() as u64).to_be_bytes());
    tail.as_chunks::<64>().0.iter().for_each(|block| stir(&mut state, block));
    state.iter().map(|word| format!("{word:08x}")).collect()
}

/// The digest of several texts, which `["ab", "c"]` and `["a", "bc"]` do not share.
pub(crate) fn hex_of(parts: &[&[u8]]) -> String {
    let mut all = Vec::new();
    for part in parts {
        all.extend((part.len() as u64).to_be_bytes());
        all.extend_from_slice(part);
    }
    hex(&all)
}

fn stir(state: &mut [u32; 8], block: &[u8; 64]) {
    let mut w = [0_u32; 64];
    for (w, bytes) in w.iter_mut().zip(block.as_chunks::<4>().0) {
        *w = u32::from_be_bytes(*bytes);
    }
    for t in 16..64 {
        let [a, b] = [w[t - 15], w[t - 2]];
        let small = a.rotate_right(7) ^ a.rotate_right(18) ^ (a >> 3);
        let large = b.rotate_right(17) ^ b.rotate_right(19) ^ (b >> 10);
        w[t] = w[t - 16].wrapping_add(small).wrapping_add(w[t - 7]).wrapping_add(large);
    }
    let [mut a, mut b, mut c, mut d, mut e, mut f, mut g, mut h] = *state;
    for t in 0..64 {
        let sum = e.rotate_right(6) ^ e.rotate_right(11) ^ e.rotate_right(25);
        let choice = (e & f) ^ (!e & g);
        let one = h.wrapping_add(sum).wrapping_add(choice).wrapping_add(K[t]).wrapping_add(w[t]);
        let sum = a.rotate_right(2) ^ a.rotate_right(13) ^ a.rotate_right(22);
        let majority = (a & b) ^ (a & c) ^ (b & c);
        let two = sum.wrapping_add(majority);
        (h, g, f, e, d, c, b, a) = (g, f, e, d.wrapping_add(one), c, b, a, one.wrapping_add(two));
    }
    for (old, new) in state.iter_mut().zip([a, b, c, d, e, f, g, h]) {
        *old = old.wrapping_add(new);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The examples of the standard's authors (NIST), and what `sha256sum` says.
    #[test]
    fn digests_are_those_of_the_standard() {
        assert_eq!((K[0], K[63]), (0x428a_2f98, 0xc671_78f2));
        for (text, digest) in [
            ("", "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"),
            ("abc", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"),
            (
                "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq",
                "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1",
            ),
        ] {
            assert_eq!(hex(text.as_bytes()), digest);
        }
        let million = "a".repeat(1_000_000);
        assert_eq!(
            hex(million.as_bytes()),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0"
        );
        assert_ne!(hex_of(&[b"ab", b"c"]), hex_of(&[b"a", b"bc"]));
    }
}
