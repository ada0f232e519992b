//! Reads the keys of the first level of a YAML file, with their values and positions.

use saphyr_parser::{Event, Marker, Parser, Span, StrInput};

use crate::limits::DEEPEST_LIST;

/// A position (byte) and the description of the fault.
pub(super) type Wrong = (usize, String);

/// A key of the first level.
pub(super) struct Key {
    pub(super) name: String,
    pub(super) at: usize,
    pub(super) value: Node,
}

/// A value with its position.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Node {
    Text(String, usize),
    List(Vec<Node>, usize),
    /// Keys below the first level are not read.
    Keys(usize),
}

impl Node {
    /// The texts of a list.
    pub(super) fn texts(&self) -> Option<Vec<(&str, usize)>> {
        let Self::List(items, _) = self else {
            return None;
        };
        let text = |item| match item {
            &Self::Text(ref text, at) => Some((text.as_str(), at)),
            Self::List(..) | Self::Keys(_) => None,
        };
        items.iter().map(text).collect()
    }
}

/// The keys of a file, in their order.
///
/// # Errors
/// The file is not YAML, has no keys or several documents, or contains unsupported elements:
/// aliases and deep lists.
pub(super) fn keys(text: &str) -> Result<Vec<Key>, Wrong> {
    let mut events = Events::of(text);
    let mut keys = Vec::new();
    match events.next()? {
        (Event::StreamEnd, _) => return Ok(keys),
        (Event::MappingStart(..), _) => {}
        (_, at) => return Err((at, "expected `key:`".to_owned())),
    }
    loop {
        let (name, at) = match events.next()? {
            (Event::MappingEnd, _) => break,
            (Event::Scalar(name, ..), at) => (name.into_owned(), at),
            (_, at) => return Err((at, "a key must be a text".to_owned())),
        };
        let value = events.node(0)?;
        keys.push(Key { name, at, value });
    }
    match events.next()? {
        (Event::StreamEnd, _) => Ok(keys),
        (_, at) => Err((
            at,
            "the file contains a second document; only one is supported".to_owned(),
        )),
    }
}

/// The events of the parser, with positions in bytes.
struct Events<'t> {
    parser: Parser<'t, StrInput<'t>>,
    /// The start byte of each character.
    bytes: Vec<usize>,
}

impl<'t> Events<'t> {
    fn of(text: &'t str) -> Self {
        Self {
            parser: Parser::new_from_str(text),
            bytes: text.char_indices().map(|(byte, _)| byte).collect(),
        }
    }

    fn place(&self, marker: &Marker) -> usize {
        let byte = self.bytes.get(marker.index()).or(self.bytes.last());
        byte.copied().unwrap_or(0)
    }

    /// Returns the next event of a document, or the end of the stream.
    fn next(&mut self) -> Result<(Event<'t>, usize), Wrong> {
        loop {
            let Some(next) = self.parser.next_event() else {
                return Ok((Event::StreamEnd, self.bytes.len()));
            };
            let (event, Span { start, .. }) =
                next.map_err(|error| (self.place(error.marker()), error.info().to_owned()))?;
            match event {
                Event::Nothing
                | Event::StreamStart
                | Event::DocumentStart(_)
                | Event::DocumentEnd => {}
                event => return Ok((event, self.place(&start))),
            }
        }
    }

    /// Reads the next value.
    fn node(&mut self, depth: usize) -> Result<Node, Wrong> {
        match self.next()? {
            (Event::Scalar(text, ..), at) => Ok(Node::Text(text.into_owned(), at)),
            (Event::SequenceStart(..) | Event::MappingStart(..), at) if depth == DEEPEST_LIST => {
                Err((at, "lists within too many others".to_owned()))
            }
            (Event::SequenceStart(..), at) => Ok(Node::List(self.items(depth)?, at)),
            (Event::MappingStart(..), at) => {
                self.items(depth)?;
                Ok(Node::Keys(at))
            }
            (_, at) => Err((at, "aliases are not supported: write the value".to_owned())),
        }
    }

    /// The values up to the end of a list, or the keys and values of a mapping.
    fn items(&mut self, depth: usize) -> Result<Vec<Node>, Wrong> {
        let mut items = Vec::new();
        while !matches!(
            self.parser.peek(),
            Some(Ok((Event::SequenceEnd | Event::MappingEnd, _))) | None
        ) {
            items.push(self.node(depth + 1)?);
        }
        self.parser.next_event();
        Ok(items)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_in_brackets_and_with_dashes_are_the_same() {
        let plain = |text: &str| -> Vec<Vec<String>> {
            let keys = keys(text).expect("readable");
            let Node::List(pairs, _) = &keys[0].value else {
                panic!("{:?}", keys[0].value)
            };
            let texts = |pair: &Node| {
                let texts = pair.texts().expect("texts");
                texts.iter().map(|(t, _)| (*t).to_owned()).collect()
            };
            pairs.iter().map(texts).collect()
        };
        for same in [
            "# loops\npairs:\n  [\n    [\"a\", 'b c'], # one\n    [d, e],\n  ]\n",
            "---\npairs:\n  - [a, 'b c']\n  - [d,\n     e]\n",
            "pairs:\n- - a\n  - b c\n-\n  - d\n  - e\n",
        ] {
            assert_eq!(plain(same), [["a", "b c"], ["d", "e"]], "{same}");
        }
    }

    #[test]
    fn places_are_bytes() {
        let text = "ä: [ö, ü]\nß: x\n";
        let keys = keys(text).expect("readable");
        assert_eq!(&text[keys[1].at..], "ß: x\n");
        let texts = keys[0].value.texts().expect("texts");
        assert_eq!(&text[texts[1].1..], "ü]\nß: x\n");
    }

    #[test]
    fn what_is_not_read_is_refused() {
        let deep = format!("a: {}", "[".repeat(100_000));
        let dashes = format!("a:\n  {}", "- ".repeat(10_000));
        for wrong in [
            "a",
            "a: [",
            "a: 'x",
            "a: [x] y",
            "- a",
            "[a]: b",
            "a: &x [y]\nb: *x\n",
            "a: b\n---\nc: d\n",
            &deep,
            &dashes,
        ] {
            let wrong_start = &wrong[..wrong.len().min(40)];
            assert!(keys(wrong).is_err(), "{wrong_start}");
        }
    }
}
