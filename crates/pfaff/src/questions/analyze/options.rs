//! Options of an analysis.

use std::str::FromStr;

use serde::Deserialize;

use crate::elasticity::BoundsOptions;

/// Compute rank, redundancy and a verdict for every reaction
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "command", derive(clap::Args))]
#[cfg_attr(feature = "command", command(after_help = include_str!("examples.txt")))]
pub struct Analyze {
    /// Analyse the motion at this time (s)
    #[cfg_attr(
        feature = "command",
        arg(
            long,
            value_name = "T",
            default_value_t = 0.0,
            allow_hyphen_values = true
        )
    )]
    pub at_time: f64,
    /// Rows to treat as dependent (1-based)
    // In the program they are counted from 0.
    #[serde(deserialize_with = "crate::run_options::rows")]
    #[cfg_attr(
        feature = "schema",
        schemars(with = "Option<Vec<std::num::NonZeroUsize>>")
    )]
    #[cfg_attr(feature = "command", arg(long, value_name = "ROWS", value_delimiter = ',', value_parser = crate::run_options::row))]
    pub drop: Option<Vec<usize>>,
    /// Analyse a sum of components, e.g. "W3.N + W4.N"; repeatable
    #[cfg_attr(
        feature = "command",
        arg(long, value_name = "EXPR", allow_hyphen_values = true)
    )]
    pub combine: Vec<String>,
    /// Find the fewest rows to delete for a unique reaction; repeatable
    #[cfg_attr(feature = "command", arg(long, value_name = "NAME"))]
    pub make_unique: Vec<String>,
    /// Rows that --make-unique may delete: sensible (a joint of several rows keeps one), whole
    /// (whole joints and drives), rows (any), rows:4,6,21 (only these)
    #[cfg_attr(feature = "command", arg(long, value_name = "WHAT", default_value = SENSIBLE))]
    pub allow: Permission,
    /// List up to N sets of rows that can be eliminated without changing the motion
    #[cfg_attr(feature = "command", arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "100"))]
    pub eliminations: Option<usize>,
    /// Also analyse components in the frames of body, edge and joint
    #[cfg_attr(feature = "command", arg(long))]
    pub frames: bool,
    /// Also analyse moments about a point X,Y or X,Y,Z (m) or a marker
    #[cfg_attr(
        feature = "command",
        arg(long, value_name = "POINT", allow_hyphen_values = true)
    )]
    pub about: Option<String>,
    /// Propose other types of joints that make reactions unique, also in JSON and Python; the text
    /// always does so for small mechanisms
    #[cfg_attr(feature = "command", arg(long))]
    pub remedies: bool,
    /// The bounds
    #[cfg_attr(feature = "command", command(flatten))]
    pub elastic: BoundsOptions,
    /// Print Φq, Ψ and Γ with names of rows and columns; --out writes them as CSV
    #[cfg_attr(feature = "command", arg(long))]
    pub matrices: bool,
    /// Analyse along the motion to T_END (s): the generic verdict and the intervals where it
    /// differs
    #[cfg_attr(feature = "command", arg(long, value_name = "T_END", num_args = 0..=1, default_missing_value = STATED, allow_negative_numbers = true))]
    pub along: Option<Along>,
    /// Compute reactions for a choice: minimum-norm, minimum-norm:length=L (L: arm that converts
    /// torques to forces), compliance:W3=1e-6,W4=2e-6 (m/N; NAME=M/R adds rad/(N·m)), the same with
    /// ;misfit:W3=DX,DY (m, then rad: the second body, or the ground, is displaced), drop:6,21;
    /// repeatable
    #[cfg_attr(feature = "command", arg(long, value_name = "CHOICE"))]
    pub choose: Vec<String>,
}

const SENSIBLE: &str = "sensible";

/// The permitted deletions, such as `sensible` or `rows:4,6,21`.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(transparent)]
pub struct Permission(pub String);

impl Default for Permission {
    fn default() -> Self {
        Self(SENSIBLE.to_owned())
    }
}

impl From<&str> for Permission {
    fn from(text: &str) -> Self {
        Self(text.to_owned())
    }
}
const STATED: &str = "stated";

/// End of the analysed motion.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(try_from = "TimeOrWord")]
pub enum Along {
    /// The motion is analysed up to the end that the scene states.
    Stated,
    /// The motion is analysed up to this time (s).
    To(f64),
}

impl FromStr for Along {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.parse() {
            _ if text == STATED => Ok(Self::Stated),
            Ok(time) => Ok(Self::To(time)),
            Err(_) => Err(format!("`{text}` is not a time > 0 (s)")),
        }
    }
}

#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
enum TimeOrWord {
    Time(f64),
    Word(String),
}

impl TryFrom<TimeOrWord> for Along {
    type Error = String;

    fn try_from(read: TimeOrWord) -> Result<Self, String> {
        match read {
            TimeOrWord::Time(time) => Ok(Self::To(time)),
            TimeOrWord::Word(word) => word.parse(),
        }
    }
}
