//! The tables of options in the book.

use crate::option::QuestionOption;
use crate::question::Question;

/// The page with a section for each command.
pub(crate) const PATH: &str = "docs/book/commands.md";

/// Returns the page with new tables. Each table is between two comments.
pub(crate) fn with_tables(page: &str, questions: &[Question]) -> Result<String, String> {
    let mut text = page.to_owned();
    for question in questions
        .iter()
        .filter(|question| !question.options.is_empty())
    {
        let name = question.name;
        let begin = format!("<!-- options of {name}: written by `cargo xtask questions` -->\n");
        let end = "<!-- end of options -->\n";
        let missing = || {
            format!(
                "{PATH} lacks `{}`, followed by `{}`",
                begin.trim(),
                end.trim()
            )
        };
        let (before, after) = text.split_once(&begin).ok_or_else(missing)?;
        let (_, after) = after.split_once(end).ok_or_else(missing)?;
        text = format!("{before}{begin}{}{end}{after}", table(&question.options));
    }
    Ok(text)
}

fn table(options: &[QuestionOption]) -> String {
    let mut text = "\n| option | means | default |\n| --- | --- | --- |\n".to_owned();
    for option in options {
        let (flag, help) = (&option.flag, option.help.replace('|', "\\|"));
        let default = match option.default.as_str() {
            "" => String::new(),
            default => format!("`{default}`"),
        };
        text.push_str(&format!("| `{flag}` | {help} | {default} |\n"));
    }
    text + "\n"
}
