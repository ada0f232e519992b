//! Parses XML files within limits of size and depth, and provides elements and attributes with
//! their positions in the text.

use std::ops::Range;

use model::codes::Code;
use roxmltree::{Document, Node, ParsingOptions};
use scene::{Diagnostic, SourceText};

use crate::limits::{DEEPEST, LARGEST, MOST_ATTRIBUTES, MOST_NAME_SPACES, MOST_NODES};

/// An element of a file.
#[derive(Clone, Copy)]
pub(crate) struct Element<'a> {
    node: Node<'a, 'a>,
    pub(crate) source: &'a SourceText,
}

/// A text of a file: the value of an attribute, or the content of an element.
#[derive(Clone)]
pub(crate) struct Value<'a> {
    pub(crate) text: &'a str,
    pub(crate) span: Range<usize>,
    pub(crate) source: &'a SourceText,
    /// Key and element of the text, such as `pos` of `<body>`.
    pub(crate) subject: String,
}

impl Value<'_> {
    /// The line of the start of the text.
    pub(crate) fn line(&self) -> usize {
        self.source.line(self.span.start)
    }
}

impl<'a> Element<'a> {
    /// The root of a document.
    pub(crate) fn root(document: &'a Document<'a>, source: &'a SourceText) -> Self {
        let node = document.root_element();
        Self { node, source }
    }

    /// The root of the file of the element.
    pub(crate) fn file_root(&self) -> Self {
        let (node, source) = (self.node.document().root_element(), self.source);
        Self { node, source }
    }

    pub(crate) fn name(&self) -> &'a str {
        self.node.tag_name().name()
    }

    /// Position of the opening tag.
    pub(crate) fn span(&self) -> Range<usize> {
        let range = self.node.range();
        let text = self.source.text().get(range.clone()).unwrap_or_default();
        let end = text.find(['>', '\n']).map_or(text.len(), |at| at + 1);
        range.start..range.start + end
    }

    pub(crate) fn line(&self) -> usize {
        self.source.line(self.node.range().start)
    }

    /// The child elements, except elements of other name spaces.
    pub(crate) fn children(&self) -> impl Iterator<Item = Self> + use<'a> {
        self.all_children().filter(|child| child.prefix().is_none())
    }

    /// The child elements that belong to another name space than the root.
    pub(crate) fn foreign_children(&self) -> impl Iterator<Item = Self> + use<'a> {
        self.all_children().filter(|child| child.prefix().is_some())
    }

    fn all_children(&self) -> impl Iterator<Item = Self> + use<'a> {
        let source = self.source;
        let elements = self.node.children().filter(Node::is_element);
        elements.map(move |node| Self { node, source })
    }

    /// Returns the prefix before the colon of the name, if the name space of the element differs
    /// from the name space of the root.
    pub(crate) fn prefix(&self) -> Option<&'a str> {
        let own = self.node.tag_name().namespace();
        let root = self.node.document().root_element();
        let space = own.filter(|_| own != root.tag_name().namespace())?;
        Some(self.node.lookup_prefix(space).unwrap_or_default())
    }

    /// The name space of the element name.
    pub(crate) fn name_space(&self) -> &'a str {
        self.node.tag_name().namespace().unwrap_or_default()
    }

    /// Returns the positions of the attributes with their keys. The flag is true for attributes of
    /// other name spaces.
    pub(crate) fn keys(&self) -> impl Iterator<Item = (&'a str, bool, Range<usize>)> + use<'a> {
        self.node.attributes().map(|attribute| {
            let is_foreign = attribute.namespace().is_some();
            let place = attribute.range();
            let key = attribute.name();
            (key, is_foreign, place.start..place.start + key.len())
        })
    }

    /// The first child element with this name.
    pub(crate) fn child(&self, name: &str) -> Option<Self> {
        self.children().find(|child| child.name() == name)
    }

    pub(crate) fn attribute(&self, name: &str) -> Option<Value<'a>> {
        self.attributes()
            .find(|(key, _)| *key == name)
            .map(|(_, value)| value)
    }

    pub(crate) fn attributes(&self) -> impl Iterator<Item = (&'a str, Value<'a>)> + use<'a> {
        let (source, element) = (self.source, self.name());
        let own = self.node.attributes().filter(|a| a.namespace().is_none());
        own.map(move |attribute| {
            let key = attribute.name();
            let value = Value {
                text: attribute.value(),
                span: attribute.range_value(),
                source,
                subject: format!("`{key}` of `<{element}>`"),
            };
            (key, value)
        })
    }

    /// The text in a child element with this name.
    pub(crate) fn text_of(&self, name: &str) -> Option<Value<'a>> {
        self.child(name).map(|child| child.text())
    }

    /// The text content of the element.
    pub(crate) fn text(&self) -> Value<'a> {
        let texts = self
            .node
            .children()
            .find(|node| node.is_text() && node.text().is_some_and(|text| !text.trim().is_empty()));
        let (text, span) = match texts {
            Some(node) => (node.text().unwrap_or_default(), node.range()),
            None => ("", self.span()),
        };
        let front = text.len() - text.trim_start().len();
        let trimmed = text.trim();
        let start = (span.start + front).min(span.end);
        let end = (start + trimmed.len()).min(span.end).max(start);
        Value {
            text: trimmed,
            span: start..end,
            source: self.source,
            subject: format!("`<{}>`", self.name()),
        }
    }
}

/// Parses a text. Rejects texts that declare document types or entities, and texts that exceed the
/// limits of depth or size.
pub(crate) fn parse(source: &SourceText) -> Result<Document<'_>, Box<Diagnostic>> {
    let text = source.text();
    let refuse = |code, span, message: String, label: &str| {
        Err(Box::new(Diagnostic::error(
            code, source, span, message, label,
        )))
    };
    const LARGE: Code = Code::new(603);
    if text.len() > LARGEST {
        let message = format!(
            "the file has {} bytes, more than the limit of {LARGEST}",
            text.len()
        );
        return refuse(LARGE, 0..0, message, "too large");
    }
    if let Some((at, message)) = too_much(text) {
        return refuse(LARGE, at..at + 1, message, "too much");
    }
    let options = ParsingOptions {
        allow_dtd: false,
        nodes_limit: MOST_NODES,
        ..ParsingOptions::default()
    };
    match Document::parse_with_options(text, options) {
        Ok(document) => Ok(document),
        Err(roxmltree::Error::DtdDetected) => {
            let at = text.find("<!DOCTYPE").unwrap_or(0);
            let message = "declarations of a document type are not supported, because they can define entities";
            let help = "remove it: robot models do not need it".to_owned();
            refuse(LARGE, at..at + 9, message.to_owned(), "not read")
                .map_err(|d| Box::new(d.help(help)))
        }
        Err(roxmltree::Error::NodesLimitReached) => {
            let message = format!("more than {MOST_NODES} elements and texts");
            refuse(LARGE, 0..0, message, "too large")
        }
        Err(error) => {
            let at = offset(source, error.pos());
            let said = error.to_string();
            let said = said
                .rsplit_once(" at ")
                .map_or(said.as_str(), |(what, _)| what);
            let message = format!("not XML: {said}");
            refuse(const { Code::new(601) }, at..at + 1, message, "here")
        }
    }
}

/// Returns the position at which a text first exceeds a limit. Without the limits, the stack of the
/// parser could overflow, or parsing could take more than linear time. The parser compares each
/// attribute with all other attributes of its element, and each prefix with all name spaces.
fn too_much(text: &str) -> Option<(usize, String)> {
    let (mut depth, mut spaces) = (0_usize, 0);
    let tags = Tags { text, at: 0 };
    for tag in tags {
        depth = match tag.kind {
            TagKind::Opens => depth + 1,
            TagKind::Closes => depth.saturating_sub(1),
            TagKind::IsEmpty => depth,
        };
        spaces += tag.spaces;
        let message = if depth > DEEPEST {
            format!("elements are nested more than {DEEPEST} deep")
        } else if tag.attributes > MOST_ATTRIBUTES {
            format!("an element has more than {MOST_ATTRIBUTES} attributes")
        } else if spaces > MOST_NAME_SPACES {
            format!("the file has more than {MOST_NAME_SPACES} declarations of name spaces")
        } else {
            continue;
        };
        return Some((tag.at, message));
    }
    None
}

/// Iterates over the tags of a text, as far as the text is XML.
struct Tags<'t> {
    text: &'t str,
    at: usize,
}

/// A tag: its start, its kind, its number of attributes, and the number of attributes that declare
/// name spaces.
struct Tag {
    at: usize,
    kind: TagKind,
    attributes: usize,
    spaces: usize,
}

enum TagKind {
    Opens,
    Closes,
    IsEmpty,
}

impl Iterator for Tags<'_> {
    type Item = Tag;

    fn next(&mut self) -> Option<Tag> {
        loop {
            let at = self.at + self.text[self.at..].find('<')?;
            let rest = &self.text[at..];
            let aside = [
                ("<!--", "-->"),
                ("<![CDATA[", "]]>"),
                ("<?", "?>"),
                ("<!", ">"),
            ];
            let aside = aside.iter().find(|(begin, _)| rest.starts_with(begin));
            if let Some((begin, end)) = aside {
                self.at = at + begin.len() + rest[begin.len()..].find(end)? + end.len();
                continue;
            }
            let mut tag = Tag {
                at,
                kind: TagKind::Opens,
                attributes: 0,
                spaces: 0,
            };
            let mut word = 1;
            loop {
                let sign = word + rest[word..].find(['"', '\'', '>'])?;
                let before = rest[word..sign].trim();
                let Some(quote) = rest[sign..].chars().next().filter(|sign| *sign != '>') else {
                    if rest[1..].starts_with('/') {
                        tag.kind = TagKind::Closes;
                    } else if before.ends_with('/') {
                        tag.kind = TagKind::IsEmpty;
                    }
                    self.at = at + sign + 1;
                    return Some(tag);
                };
                tag.attributes += 1;
                // The element name comes before the first attribute.
                let key = before.split_whitespace().next_back();
                tag.spaces += usize::from(key.is_some_and(|key| key.starts_with("xmlns")));
                word = sign + 2 + rest[sign + 1..].find(quote)?;
            }
        }
    }
}

/// The byte offset of a position of the parser.
fn offset(source: &SourceText, place: roxmltree::TextPos) -> usize {
    let text = source.text();
    let mut lines = text.split_inclusive('\n');
    let row = (place.row as usize).saturating_sub(1);
    let before: usize = lines.by_ref().take(row).map(str::len).sum();
    let line = lines.next().unwrap_or_default();
    let column = (place.col as usize).saturating_sub(1);
    before + line.char_indices().nth(column).map_or(0, |(at, _)| at)
}
