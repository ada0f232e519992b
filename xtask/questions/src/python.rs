//! The methods of the Python package, with typed keywords. There is one method for each question
//! whose answer is a document. Questions that write files during the computation return arrays in
//! Python. The methods of these questions are written by hand.

use crate::option::{Kind, QuestionOption};
use crate::question::Question;

/// The path of the module.
pub(crate) const PATH: &str = "python/package/pfaff/_questions.py";

/// Questions whose Python object contains more than the document: name of the question, module and
/// name of the class.
const CLASSES: [(&str, &str, &str); 4] = [
    ("analyze", "_analysis", "Analysis"),
    ("linearise", "_linearisation", "Linearisation"),
    ("tolerance", "_samples", "Samples"),
    ("work-precision", "_comparison", "WorkPrecision"),
];

/// Questions whose class reads files of the answer.
const WITH_FILES: [&str; 1] = ["tolerance"];

const HEAD: &str = r#""""Questions about a scene. Written by `cargo xtask questions`."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any

from . import _arguments as arguments
from ._answer import Answer, Common
"#;

const CLASS: &str = r#"

class Questions:
    """Questions about a scene: methods of :class:`Scene`.

    All methods accept the same final keywords. ``tolerance`` (m) and ``angle_tolerance`` (rad)
    state the accuracy of the numbers of the scene and replace the tolerances of the scene.
    ``max_memory`` (bytes, or as ``"4GB"``) rejects computations that need more; ``threads`` is the
    number of threads, by default one for each core. ``out`` is a directory for the files of the
    command of the same name.
    """

    __slots__ = ()

    def _asked(
        self,
        question: str,
        options: dict[str, Any],
        common: Common,
        others: Iterable[Questions] = (),
        files: bool = False,
    ) -> Answer:
        raise NotImplementedError
"#;

/// Keywords of all questions.
const COMMON: [(&str, &str); 4] = [
    ("tolerance", "float | None"),
    ("angle_tolerance", "float | None"),
    ("threads", "int | None"),
    ("max_memory", "int | str | None"),
];

/// The whole module.
pub(crate) fn module(questions: &[Question]) -> String {
    let asked = || questions.iter().filter(|question| !question.streams);
    let mut text = HEAD.to_owned();
    for (name, module, class) in CLASSES {
        if asked().any(|question| question.name == name) {
            text.push_str(&format!("from .{module} import {class}\n"));
        }
    }
    text.push_str(CLASS);
    for question in asked() {
        text.push_str(&method(question));
    }
    text
}

fn method(question: &Question) -> String {
    let class = CLASSES.iter().find(|(name, ..)| *name == question.name);
    let returns = class.map_or("dict[str, Any]", |(_, _, class)| class);
    let name = question.name.replace('-', "_");
    let mut text = format!("\n    def {name}(\n        self,\n");
    let others: Vec<String> = question.scenes[1..]
        .iter()
        .map(|_| "other".to_owned())
        .collect();
    for other in &others {
        text.push_str(&format!("        {other}: Questions,\n"));
    }
    for (k, option) in question.options.iter().enumerate() {
        if k == 1 {
            text.push_str("        *,\n");
        }
        let (of, default) = signature(option);
        text.push_str(&format!("        {}: {of} = {default},\n", option.key));
    }
    if question.options.len() < 2 {
        text.push_str("        *,\n");
    }
    for (name, of) in COMMON {
        text.push_str(&format!("        {name}: {of} = None,\n"));
    }
    if question.files.is_some() {
        text.push_str("        out: str | os.PathLike[str] | None = None,\n");
    }
    text.push_str(&format!("    ) -> {returns}:\n"));
    text.push_str(&documentation(question));
    let has_options = !question.options.is_empty();
    text.push_str("        options: dict[str, Any] = {");
    if has_options {
        text.push('\n');
    }
    let mut inside = None;
    for option in &question.options {
        if option.inside != inside {
            if inside.is_some() {
                text.push_str("            },\n");
            }
            if let Some(inside) = &option.inside {
                text.push_str(&format!("            \"{inside}\": {{\n"));
            }
            inside.clone_from(&option.inside);
        }
        let indent = if inside.is_some() { "    " } else { "" };
        let (key, value) = (&option.key, checked(option));
        text.push_str(&format!("            {indent}\"{key}\": {value},\n"));
    }
    if inside.is_some() {
        text.push_str("            },\n");
    }
    text.push_str(if has_options { "        }\n" } else { "}\n" });
    let place = if question.files.is_some() {
        ", out"
    } else {
        ""
    };
    let others = match &others[..] {
        [] => String::new(),
        others => format!(", [{}]", others.join(", ")),
    };
    let files = if WITH_FILES.contains(&question.name) {
        ", files=True"
    } else {
        ""
    };
    text.push_str(&format!(
        "        common = Common(tolerance, angle_tolerance, threads, max_memory{place})\n        \
         answer = self._asked(\"{}\", options, common{others}{files})\n",
        question.name,
    ));
    text.push_str(&match class {
        Some((_, _, class)) => format!("        return {class}(answer)\n"),
        None => "        return answer.document\n".to_owned(),
    });
    text
}

/// Type and default of an argument.
fn signature(option: &QuestionOption) -> (String, String) {
    let of = match option.kind {
        Kind::Flag => "bool",
        Kind::Count => "int",
        Kind::Number => "float",
        Kind::Text => "str",
        Kind::NumberOrWord => "float | str",
        Kind::Rows => "Iterable[int]",
        Kind::Texts => "Iterable[str]",
        Kind::Settings => "Mapping[str, str] | Iterable[str]",
    };
    if option.optional {
        return (format!("{of} | None"), "None".to_owned());
    }
    let default = match (&option.kind, option.default.as_str()) {
        (Kind::Flag, _) => "False".to_owned(),
        (Kind::Rows | Kind::Texts | Kind::Settings, _) => "()".to_owned(),
        (Kind::Text, word) => format!("{word:?}"),
        (Kind::Number, number) if !number.contains(['.', 'e']) => format!("{number}.0"),
        (_, number) => number.to_owned(),
    };
    (of.to_owned(), default)
}

/// The value of an option in the object of options, with a check of its type.
fn checked(option: &QuestionOption) -> String {
    let key = &option.key;
    let check = match option.kind {
        Kind::Flag => "flag",
        Kind::Count => "count",
        Kind::Number => "finite",
        Kind::Text => "text",
        Kind::NumberOrWord => "finite_or_word",
        Kind::Rows => "rows",
        Kind::Texts => "texts",
        Kind::Settings => "settings",
    };
    if option.optional {
        format!("arguments.maybe(arguments.{check}, \"{key}\", {key})")
    } else {
        format!("arguments.{check}(\"{key}\", {key})")
    }
}

/// Description of the method and of its arguments.
fn documentation(question: &Question) -> String {
    let command = question.name;
    let about = in_python(&question.about);
    let mut text = format!("        \"\"\"{about}.\n\n");
    text.push_str(&wrapped(
        &format!("As ``pfaff {command} --json``."),
        "        ",
        "        ",
    ));
    if !question.options.is_empty() {
        text.push('\n');
    }
    for option in &question.options {
        let line = format!("``{}``: {}", option.key, in_python(&option.help));
        text.push_str(&wrapped(&line, "        - ", "          "));
    }
    text.push_str("        \"\"\"\n");
    text
}

/// Converts a text of the command line to Python terms: `--at-time` becomes ``at_time``, and an
/// option that can be repeated becomes a list.
fn in_python(text: &str) -> String {
    let text = text
        .replace("; may be given several times", "")
        .replace("; repeatable", "");
    let mut words = Vec::new();
    for word in text.split(' ') {
        words.push(match word.strip_prefix("--") {
            Some(option) => {
                let end = option.find(|c: char| !(c.is_alphanumeric() || c == '-'));
                let (name, rest) = option.split_at(end.unwrap_or(option.len()));
                format!("``{}``{rest}", name.replace('-', "_"))
            }
            None => word.replace('`', "``"),
        });
    }
    words.join(" ")
}

/// A text in lines of at most 100 characters.
fn wrapped(text: &str, first: &str, next: &str) -> String {
    let mut lines = Vec::new();
    let mut line = first.to_owned();
    let mut is_empty = true;
    for word in text.split_whitespace() {
        if !is_empty && line.chars().count() + 1 + word.chars().count() > 100 {
            lines.push(std::mem::replace(&mut line, next.to_owned()));
            is_empty = true;
        }
        if !is_empty {
            line.push(' ');
        }
        line.push_str(word);
        is_empty = false;
    }
    lines.push(line);
    lines.join("\n") + "\n"
}
