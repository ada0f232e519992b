//! The table and the key at a position of a scene. While its author writes, a scene is not valid
//! TOML, so this module reads only brackets, keys, strings and comments.

use std::ops::Range;

/// What can be written at a position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// The name of a section between brackets.
    Header,
    /// A key.
    Key,
    /// The value of a key, or an item of it.
    Value,
}

/// A position in a scene.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cursor {
    pub(crate) part: Part,
    /// Keys from the root to the table. At a header, its own name.
    pub(crate) path: Vec<String>,
    /// The key whose value contains the position, or the key at the position.
    pub(crate) key: String,
    /// The word at the position (bytes), without quotes.
    pub(crate) word: Range<usize>,
    /// Whether the word is a string in quotes.
    pub(crate) is_quoted: bool,
    /// Index of the table in [`Outline::tables`].
    pub(crate) table: usize,
}

/// A table of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct OutlineTable {
    pub(crate) path: Vec<String>,
    /// Keys, each with its value if the value is one string.
    pub(crate) keys: Vec<(String, Option<String>)>,
}

impl OutlineTable {
    /// The text of a key.
    pub(crate) fn text(&self, key: &str) -> Option<&str> {
        let mut keys = self.keys.iter();
        keys.find(|(name, _)| name == key)?.1.as_deref()
    }
}

/// The tables of a scene, and the position in it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outline {
    pub(crate) tables: Vec<OutlineTable>,
    pub(crate) cursor: Option<Cursor>,
}

/// Number of brackets in each other that are read as tables. The reader of scenes refuses more.
const DEEPEST: usize = 100;

/// An open bracket of a value.
enum Open {
    /// An inline table: the table around it, and the key in it.
    Table(usize, String),
    /// A list.
    List,
}

struct Reader<'t> {
    text: &'t str,
    at: usize,
    /// Byte of the cursor.
    wanted: usize,
    outline: Outline,
    /// The current table.
    table: usize,
    /// The key whose value is read. It is empty before a key.
    key: String,
    open: Vec<Open>,
}

impl Outline {
    /// Reads a scene up to its end. `at` is the position of the cursor (bytes).
    pub(crate) fn read(text: &str, at: usize) -> Self {
        let mut reader = Reader {
            text,
            at: 0,
            wanted: at,
            outline: Self {
                tables: vec![OutlineTable::default()],
                cursor: None,
            },
            table: 0,
            key: String::new(),
            open: Vec::new(),
        };
        while reader.step() {}
        if reader.outline.cursor.is_none() {
            reader.place(text.len()..text.len(), false);
        }
        reader.outline
    }

    /// The texts of a key in all tables of a section.
    pub(crate) fn texts<'o>(
        &'o self,
        section: &'o str,
        key: &'o str,
    ) -> impl Iterator<Item = &'o str> {
        let own = self
            .tables
            .iter()
            .filter(move |table| table.path == [section]);
        own.filter_map(move |table| table.text(key))
    }
}

impl Reader<'_> {
    /// Reads the next token. Returns false at the end.
    fn step(&mut self) -> bool {
        let rest = &self.text[self.at..];
        let Some(c) = rest.chars().next() else {
            return false;
        };
        let begin = self.at;
        // A cursor between two tokens is before the second one.
        if self.outline.cursor.is_none() && self.wanted <= begin && !is_word(c) && !is_quote(c) {
            self.place(self.wanted..self.wanted, false);
        }
        self.at += c.len_utf8();
        match c {
            '#' => self.at = begin + rest.find('\n').unwrap_or(rest.len()),
            '\n' if self.open.is_empty() => self.key.clear(),
            '[' if self.key.is_empty() && self.open.is_empty() => self.header(begin),
            '{' if self.open.len() < DEEPEST => {
                let mut path = self.outline.tables[self.table].path.clone();
                path.push(self.key.clone());
                self.open.push(Open::Table(self.table, self.key.clone()));
                self.begin(path);
            }
            '[' | '{' => self.open.push(Open::List),
            '}' | ']' => match self.open.pop() {
                Some(Open::Table(table, key)) => (self.table, self.key) = (table, key),
                Some(Open::List) | None => {}
            },
            ',' if matches!(self.open.last(), Some(Open::Table(..))) => self.key.clear(),
            _ if is_quote(c) => self.string(begin, c),
            _ if is_word(c) => self.word(begin),
            _ => {}
        }
        true
    }

    fn begin(&mut self, path: Vec<String>) {
        self.table = self.outline.tables.len();
        self.key.clear();
        self.outline.tables.push(OutlineTable {
            path,
            keys: Vec::new(),
        });
    }

    fn header(&mut self, begin: usize) {
        let line = &self.text[begin..];
        let line = &line[..line.find('\n').unwrap_or(line.len())];
        let name = line.trim_start_matches('[');
        let name = &name[..name.find([']', '#']).unwrap_or(name.len())];
        let from = begin + (line.len() - line.trim_start_matches('[').len());
        let path = name.split('.').map(|part| unquoted(part.trim()).to_owned());
        self.begin(path.collect());
        let end = from + name.len();
        if self.outline.cursor.is_none() && self.wanted <= end {
            self.place(from..end, false);
            if let Some(cursor) = &mut self.outline.cursor {
                cursor.part = Part::Header;
            }
        }
        self.at = begin + line.len();
    }

    fn string(&mut self, begin: usize, quote: char) {
        let mark: String = std::iter::repeat_n(quote, 3).collect();
        let rest = &self.text[begin..];
        let (from, end) = if rest.starts_with(&mark) {
            let close = rest[3..].find(&mark).map_or(rest.len(), |k| k + 3);
            (begin + 3, begin + close)
        } else {
            let mut is_escaped = false;
            let close = rest[1..].char_indices().find(|(_, c)| {
                let ends = *c == '\n' || (*c == quote && !is_escaped);
                is_escaped = quote == '"' && *c == '\\' && !is_escaped;
                ends
            });
            (begin + 1, begin + close.map_or(rest.len(), |(k, _)| k + 1))
        };
        let width = if from == begin + 3 { 3 } else { 1 };
        let closes = self.text[end..].starts_with(quote);
        self.at = if closes { end + width } else { end };
        if self.wanted > begin && self.wanted <= end {
            self.place(from..end, true);
        }
        let text = self.text[from.min(end)..end].to_owned();
        self.took(text, true);
    }

    fn word(&mut self, begin: usize) {
        let rest = &self.text[begin..];
        let end = begin + rest.find(|c| !is_word(c)).unwrap_or(rest.len());
        self.at = end;
        if self.outline.cursor.is_none() && self.wanted <= end {
            self.place(begin..end, false);
        }
        self.took(self.text[begin..end].to_owned(), false);
    }

    /// Takes a word as a key, or as a value.
    fn took(&mut self, word: String, is_string: bool) {
        if self.key.is_empty() {
            let rest = self.text[self.at..].trim_start_matches([' ', '\t']);
            if rest.starts_with('=') {
                self.outline.tables[self.table]
                    .keys
                    .push((word.clone(), None));
                self.key = word;
            }
        } else if is_string && !matches!(self.open.last(), Some(Open::List)) {
            let own = self.outline.tables[self.table].keys.last_mut();
            if let Some((_, text)) = own {
                *text = Some(word);
            }
        }
    }

    fn place(&mut self, word: Range<usize>, is_quoted: bool) {
        if self.outline.cursor.is_some() {
            return;
        }
        let part = if self.key.is_empty() {
            Part::Key
        } else {
            Part::Value
        };
        let key = match part {
            Part::Key => self.text[word.clone()].to_owned(),
            _ => self.key.clone(),
        };
        self.outline.cursor = Some(Cursor {
            part,
            path: self.outline.tables[self.table].path.clone(),
            key,
            word,
            is_quoted,
            table: self.table,
        });
    }
}

fn is_quote(c: char) -> bool {
    c == '"' || c == '\''
}

/// Whether a character is part of a key or of a number.
fn is_word(c: char) -> bool {
    c.is_alphanumeric() || "_-+.".contains(c)
}

fn unquoted(name: &str) -> &str {
    name.trim_matches(['"', '\''])
}
