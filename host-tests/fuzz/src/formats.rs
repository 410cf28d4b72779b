//! The hardware model's formats: any bits are decoded or refused, and encoding gives them back.

use arbitrary::{Result, Unstructured};
use scanbeam_model::{
    FormatWord, InputFormat, PLACE, ParameterRam, Segment, Token, TokenBits, VertexFormat,
    WORD_BITS, ZFlags, draw,
};

/// Tokens and vertices of the bytes; panics when something does not hold. How many pixel tokens
/// came of them.
pub fn run(data: &[u8]) -> usize {
    let mut u = Unstructured::new(data);
    // Bytes that end too soon are a case that ends too soon.
    tokens(&mut u).and_then(|()| vertices(&mut u)).unwrap_or(0)
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

fn vertices(u: &mut Unstructured<'_>) -> Result<usize> {
    // Mostly a description that adds up, with a place, else hardly any would be one.
    let mut table = vec![
        FormatWord(0),
        FormatWord::parameter(PLACE, InputFormat::U16x2),
    ];
    let mut count = 1;
    for _ in 0..u.int_in_range(0..=34u8)? {
        let format = *u.choose(&InputFormat::ALL)?;
        count += format.words() as u16;
        table.push(FormatWord::parameter(u.arbitrary()?, format));
    }
    table[0] = FormatWord(count);
    if u.ratio(1, 4)? {
        let at = u.choose_index(table.len())?;
        table[at] = FormatWord(u.arbitrary()?);
    }
    let address = if u.ratio(1, 8)? {
        u.choose_index(table.len() + 1)?
    } else {
        0
    };
    let Ok(format) = VertexFormat::read(&table, address) else {
        return Ok(0);
    };
    let words = format.words();
    assert!((1..=31).contains(&words));
    for entry in format.entries() {
        assert!(entry.word + entry.format.words() <= words, "{entry:?}");
    }
    let mut ram = ParameterRam::new();
    let stream = u.arbitrary()?;
    for vertex in 0..3 {
        let given = if u.ratio(1, 8)? {
            u.int_in_range(0..=words)?
        } else {
            words
        };
        let given: Vec<u32> = (0..given).map(|_| u.arbitrary()).collect::<Result<_>>()?;
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
    Ok(usize::from(pixels))
}
