//! The options and arguments of the command line.

mod examples;
mod known;
mod values;

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use pfaff::command::named;
use pfaff::import::{Base, Drives};
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
    term_width = 80,
    after_help = "Exit codes: 0 done, 1 the computation stopped, 2 the input is wrong."
)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Subcommand)]
pub(crate) enum Command {
    #[command(flatten)]
    Ask(Box<AskCommand>),
    /// Create a scene from a template, or list the templates
    #[command(after_help = examples::NEW)]
    New(New),
    /// Convert a robot model (MJCF, URDF, SDF) to a scene
    #[command(after_help = examples::IMPORT)]
    Import(Import),
    /// Draw the assembled start, with joints marked by their verdicts
    #[command(after_help = examples::VIEW)]
    View(View),
    /// Explain an error code, or list all codes
    #[command(after_help = examples::EXPLAIN)]
    Explain(Explain),
    /// Print the JSON schema of scenes or of an answer
    #[command(after_help = examples::SCHEMA)]
    Schema(Schema),
    /// Print completions for a shell
    #[command(after_help = examples::COMPLETIONS)]
    Completions(Completions),
    /// Print the manual page
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
    /// Template [default: list all templates]
    #[arg(value_parser = named(Template::ALL, Template::name), value_name = "TEMPLATE")]
    pub(crate) template: Option<Template>,
    /// Output file, or - for standard output [default: TEMPLATE.toml]
    #[arg(long, value_name = "FILE", requires = "template")]
    pub(crate) out: Option<PathBuf>,
    /// Overwrite an existing file
    #[arg(long, requires = "template")]
    pub(crate) force: bool,
    /// Print the written file or the templates as a JSON document
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct Import {
    /// Model file, or - for standard input; its root element states the format
    pub(crate) file: PathBuf,
    /// Output file, or - for standard output
    #[arg(long, value_name = "SCENE")]
    pub(crate) out: PathBuf,
    /// Overwrite an existing file
    #[arg(long)]
    pub(crate) force: bool,
    /// Keep fixed links as bodies with `fixed` joints [default: merge them]
    #[arg(long)]
    pub(crate) keep_fixed: bool,
    /// Root link of a URDF
    #[arg(long, value_name = "BASE", default_value = "fixed", value_parser = named(&Base::ALL, Base::name))]
    pub(crate) base: Base,
    /// YAML file with the loop closures of a URDF
    #[arg(long, value_name = "YAML")]
    pub(crate) loops: Option<PathBuf>,
    /// Close loops near these coordinates (m, rad), e.g. knee=0.6,hip=-0.3
    #[arg(long, value_name = "JOINT=VALUE", value_delimiter = ',', allow_hyphen_values = true, value_parser = joint_value, conflicts_with = "keyframe")]
    pub(crate) pose: Vec<(String, f64)>,
    /// Correct loop axes that are nearly parallel or nearly intersect
    #[arg(long)]
    pub(crate) snap: bool,
    /// Start at a keyframe of the file
    #[arg(long, value_name = "NAME")]
    pub(crate) keyframe: Option<String>,
    /// Add drives from actuators, with zero torque or locked
    #[arg(long, value_name = "DRIVES", default_value = "none", value_parser = named(&Drives::ALL, Drives::name))]
    pub(crate) drives: Drives,
    /// Read only one model of an SDF file
    #[arg(long, value_name = "NAME")]
    pub(crate) model: Option<String>,
    #[command(flatten)]
    pub(crate) memory: Memory,
    /// Print omissions and written files as a JSON document
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct View {
    /// Scene file, or - for standard input
    pub(crate) scene: PathBuf,
    /// Output file: page (.html) or picture (.svg, .png) [default: SCENE.html in this directory]
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Write the picture to SCENE.png in this directory
    #[arg(long, conflicts_with = "out")]
    pub(crate) png: bool,
    /// PNG pixels per px of the picture (960 px wide), 0.1 to 20 [default: 2]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(crate) scale: Option<f64>,
    /// Overwrite a file not created by pfaff
    #[arg(long)]
    pub(crate) force: bool,
    /// Do not open the file
    #[arg(long)]
    pub(crate) no_open: bool,
    #[command(flatten)]
    pub(crate) known: SceneOptions,
    #[command(flatten)]
    pub(crate) resources: Resources,
    /// Print the written file as a JSON document; do not open it
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct Explain {
    /// Error code, e.g. P0102
    pub(crate) code: Option<String>,
    /// The page of the book with all codes
    #[arg(long, hide = true, conflicts_with = "json")]
    pub(crate) book: bool,
    /// Print the code, or all codes, as a JSON document
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct Schema {
    /// Command whose JSON answer is described [default: scene files]
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
    /// Command whose page is printed [default: page of all commands]
    pub(crate) command: Option<String>,
}
