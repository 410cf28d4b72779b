//! The hardware model's formats: any bits are decoded or refused, and encoding gives them back.

use arbitrary::{Result, Unstructured};
use scanbeam::model::{
    FormatWord, InputFormat, ParameterRam, Segment, Token, TokenBits, VertexFormat, WORD_BITS,
    ZFlags, draw,
};

/// Tokens and vertices of the bytes; panics when something does not hold.
pub fn run(data: &[u8]) {
    let mut u = Unstructured::new(data);
    let _ = tokens(&mut u).and_then(|()| vertices(&mut u));
}

fn tokens(u: &mut Unstructured<'_>) -> Result<()> {
    for _ in 0..u.int_in_range(0..=4u8)? {
        let bits = TokenBits::truncated(u.arbitrary()?);
        if let Ok(token) = Token::decode(bits) {
            let wires = token.encode();
            assert_eq!(Token::decode(wires), Ok(token), "{bits:?}");
            // A null token and the empty bits of a jam are not kept.
            if !matches!(token, Token::Null | Token::Jam(_)) {
                assert_eq!(wires, bits, "{token:?}");
            }
        }
    }
    Ok(())
}

fn vertices(u: &mut Unstructured<'_>) -> Result<()> {
    let length = u.int_in_range(0..=34usize)?;
    let mut table = Vec::new();
    for _ in 0..length {
        // Mostly entries, else hardly any table would be one.
        table.push(FormatWord(match u.int_in_range(0..=7u8)? {
            0 => u.arbitrary()?,
            1 => u16::from(u.int_in_range(0..=32u8)?),
            _ => FormatWord::parameter(u.arbitrary()?, *u.choose(&InputFormat::ALL)?).0,
        }));
    }
    let address = u.int_in_range(0..=length)?;
    let Ok(format) = VertexFormat::read(&table, address) else {
        return Ok(());
    };
    let words = format.words();
    assert!((1..=31).contains(&words));
    for entry in format.entries() {
        assert!(entry.word + entry.format.words() <= words, "{entry:?}");
    }
    let mut ram = ParameterRam::new();
    let stream = u.arbitrary()?;
    for vertex in 0..3 {
        let given: Vec<u32> = (0..u.int_in_range(0..=words)?)
            .map(|_| u.arbitrary())
            .collect::<Result<_>>()?;
        let loaded = ram.load(stream, vertex, &format, &given);
        assert_eq!(loaded.is_ok(), given.len() == words);
        if loaded.is_err() {
            continue;
        }
        for entry in format.entries() {
            let at = |i: usize| given.get(entry.word + i).copied().unwrap_or(0);
            let word = ram.get(stream, vertex, entry.number);
            assert_eq!(word, entry.format.convert(at(0), at(1)));
            assert_eq!(word >> WORD_BITS, 0);
            let processing = entry.format.processing();
            assert_eq!(processing.pack(processing.unpack(word)), word);
        }
    }
    let segment = Segment {
        column: u.int_in_range(0..=8191)?,
        width: u.int_in_range(0..=64)?,
        y: u.arbitrary()?,
    };
    let flags = ZFlags {
        diffuse: u.arbitrary()?,
        front: u.arbitrary()?,
        force_additive: u.arbitrary()?,
    };
    let mut pixels = 0;
    draw(
        &ram,
        &format,
        (stream, [0, 1, 2]),
        segment,
        flags,
        &mut |token| {
            assert_eq!(Token::decode(token.encode()), Ok(token));
            if let Token::Pixel(pixel) = token {
                assert!(pixel.x < segment.width, "{pixel:?}");
                pixels += 1;
            }
        },
    );
    assert!(pixels <= segment.width);
    Ok(())
}
