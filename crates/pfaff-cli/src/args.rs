//! The options and arguments of the command line.

mod examples;
mod known;
mod values;

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use pfaff::command::named;
use pfaff::import::Base;
use pfaff::questions::Questions;
use pfaff::template::Template;

pub(crate) use known::{SceneOptions, Settings};
use values::joint_value;

use crate::ask::AskCommand;
use crate::output::Answer;
use crate::resources::{Memory, Resources};

/// Mechanisms with redundant constraints: how they move, and which of their joint reactions are
/// unique.
#[derive(Parser)]
#[command(
    name = "pfaff",
    version,
    after_help = "Exit codes: 0 done, 1 the computation stopped, 2 the input is wrong."
)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Subcommand)]
pub(crate) enum Command {
    #[command(flatten)]
    Ask(AskCommand),
    /// Create a scene from a template; without a name, list the templates
    #[command(after_help = examples::NEW)]
    New(New),
    /// A scene from a model of a robot: MJCF, URDF or SDF
    #[command(after_help = examples::IMPORT)]
    Import(Import),
    /// Draw the assembled start, with joints marked by their verdicts
    #[command(after_help = examples::VIEW)]
    View(View),
    /// What the code of an error means, and what to do; without a code, list all
    #[command(after_help = examples::EXPLAIN)]
    Explain(Explain),
    /// The JSON schema of scene files, for editors, or that of an answer
    #[command(after_help = examples::SCHEMA)]
    Schema(Schema),
    /// Completions for a shell, on standard output
    #[command(after_help = examples::COMPLETIONS)]
    Completions(Completions),
    /// The manual page, on standard output
    #[command(after_help = examples::MAN)]
    Man(Man),
}

impl Command {
    /// The form of the answer: words or JSON.
    pub(crate) fn answer(&self) -> Answer {
        let json = match self {
            Self::Ask(asked) => return asked.answer(),
            Self::New(New { json, .. })
            | Self::Import(Import { json, .. })
            | Self::View(View { json, .. })
            | Self::Explain(Explain { json, .. }) => *json,
            Self::Schema(_) | Self::Completions(_) | Self::Man(_) => false,
        };
        if json { Answer::Json } else { Answer::Words }
    }
}

#[derive(Args)]
pub(crate) struct New {
    /// The template; without it, list all templates
    #[arg(value_parser = named(Template::ALL, Template::name), value_name = "TEMPLATE")]
    pub(crate) template: Option<Template>,
    /// File for the scene, or - for standard output; default: TEMPLATE.toml
    #[arg(long, value_name = "FILE", requires = "template")]
    pub(crate) out: Option<PathBuf>,
    /// Replace an existing file
    #[arg(long, requires = "template")]
    pub(crate) force: bool,
    /// The written file, or the templates, as one JSON document on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct Import {
    /// File to import, or - for standard input; its root tells the format
    pub(crate) file: PathBuf,
    /// File for the scene, or - for standard output
    #[arg(long, value_name = "SCENE")]
    pub(crate) out: PathBuf,
    /// Replace an existing file
    #[arg(long)]
    pub(crate) force: bool,
    /// Keep links that are fixed to others as bodies with `fixed` joints; by default they become
    /// parts of the others
    #[arg(long)]
    pub(crate) keep_fixed: bool,
    /// What becomes of the root link of a URDF
    #[arg(long, value_name = "BASE", default_value = "fixed", value_parser = named(&Base::ALL, Base::name))]
    pub(crate) base: Base,
    /// A YAML file with the loops of a URDF: `closed_loop`, pairs of links, and `type`, 3d or 6d
    #[arg(long, value_name = "YAML")]
    pub(crate) loops: Option<PathBuf>,
    /// Values of coordinates near which loops are closed (m, rad), as knee=0.6,hip=-0.3
    #[arg(long, value_name = "JOINT=VALUE", value_delimiter = ',', allow_hyphen_values = true, value_parser = joint_value, conflicts_with = "keyframe")]
    pub(crate) pose: Vec<(String, f64)>,
    /// Make axes of a loop parallel, or make them meet, where they nearly are or do
    #[arg(long)]
    pub(crate) snap: bool,
    /// Start at this keyframe of the file
    #[arg(long, value_name = "NAME")]
    pub(crate) keyframe: Option<String>,
    #[command(flatten)]
    pub(crate) memory: Memory,
    /// What is left out, and what was written, as one JSON document on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct View {
    /// Scene file, or - for standard input
    pub(crate) scene: PathBuf,
    /// File to write: a page (.html) or only its picture (.svg, .png); by default a page with the
    /// name of the scene file, in this directory
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Write the picture as PNG, with the name of the scene file, in this directory
    #[arg(long, conflicts_with = "out")]
    pub(crate) png: bool,
    /// Pixels of a PNG for each px of the picture, which is 960 px wide, from 0.1 to 20; by default
    /// 2
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(crate) scale: Option<f64>,
    /// Also replace a file that pfaff has not written
    #[arg(long)]
    pub(crate) force: bool,
    /// Do not open the file
    #[arg(long)]
    pub(crate) no_open: bool,
    #[command(flatten)]
    pub(crate) known: SceneOptions,
    #[command(flatten)]
    pub(crate) resources: Resources,
    /// The written file as one JSON document on standard output; opens nothing
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct Explain {
    /// The code, as P0102
    pub(crate) code: Option<String>,
    /// The page of the book with all codes
    #[arg(long, hide = true, conflicts_with = "json")]
    pub(crate) book: bool,
    /// The code, or all codes, as one JSON document on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct Schema {
    /// The question whose answer with --json is described; without it: scene files
    #[arg(value_parser = PossibleValuesParser::new(Questions::FACTS.iter().map(|facts| facts.name)))]
    pub(crate) question: Option<String>,
}

#[derive(Args)]
pub(crate) struct Completions {
    /// The shell
    pub(crate) shell: Shell,
}

#[derive(Args)]
pub(crate) struct Man {
    /// The command whose page is printed; without it, the page of all commands
    pub(crate) command: Option<String>,
}
