//! The questions, as seen by users.

use clap::{Command, Subcommand};
use pfaff::questions::Questions;
use serde_json::Value;

use crate::option::QuestionOption;

/// A question, as seen by users.
pub(crate) struct Question {
    /// Name of the subcommand and of the method.
    pub(crate) name: &'static str,
    /// Description of the answer in one line.
    pub(crate) about: String,
    pub(crate) options: Vec<QuestionOption>,
    /// Names of the scenes that the question needs.
    pub(crate) scenes: &'static [&'static str],
    /// Description of the files of the answer, if it has files.
    pub(crate) files: Option<&'static str>,
    /// Whether the files are written while the answer is computed.
    pub(crate) streams: bool,
    /// JSON schema of the answer.
    pub(crate) answer: Value,
}

/// All questions, in the order of the list.
pub(crate) fn questions() -> Vec<Question> {
    let mut program = Questions::augment_subcommands(Command::new("pfaff"));
    // After this call, the numbers of values and the defaults are available.
    program.build();
    let schemas = Questions::schemas().into_iter();
    let questions = schemas.zip(Questions::FACTS).map(|(schema, facts)| {
        let command = program.find_subcommand(schema.name);
        let command = command.expect("each question is a subcommand");
        let about = command.get_about().map(ToString::to_string);
        let arguments = command.get_arguments();
        let arguments = arguments.filter(|argument| argument.get_id() != "help");
        let options = schema.options.to_value();
        Question {
            name: schema.name,
            about: about.unwrap_or_default(),
            options: arguments
                .map(|argument| QuestionOption::new(argument, &options))
                .collect(),
            scenes: facts.scenes,
            files: facts.output.map(|output| output.contents),
            streams: facts.output.is_some_and(|output| output.is_streamed()),
            answer: schema.answer.to_value(),
        }
    });
    questions.collect()
}
