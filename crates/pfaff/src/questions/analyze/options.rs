//! What can be asked of an analysis.

use std::str::FromStr;

use serde::Deserialize;

/// Rank, redundancy, and the verdict of every reaction
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "command", derive(clap::Args))]
#[cfg_attr(feature = "command", command(after_help = include_str!("examples.txt")))]
pub struct Analyze {
    /// Time of the motion at which the mechanism is analysed (s)
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
    /// Rows to take as the dependent ones, counted from 1
    // In the program they are counted from 0.
    #[serde(deserialize_with = "crate::run_options::rows")]
    #[cfg_attr(
        feature = "schema",
        schemars(with = "Option<Vec<std::num::NonZeroUsize>>")
    )]
    #[cfg_attr(feature = "command", arg(long, value_name = "ROWS", value_delimiter = ',', value_parser = crate::run_options::row))]
    pub drop: Option<Vec<usize>>,
    /// A sum of components to judge, as "W3.N + W4.N"; may be given several times
    #[cfg_attr(
        feature = "command",
        arg(long, value_name = "EXPR", allow_hyphen_values = true)
    )]
    pub combine: Vec<String>,
    /// Find the smallest sets of rows to delete so that this reaction becomes unique; may be given
    /// several times
    #[cfg_attr(feature = "command", arg(long, value_name = "NAME"))]
    pub make_unique: Vec<String>,
    /// What may be deleted for --make-unique: sensible (no joint of several rows loses all of
    /// them), whole (joints and drives as a whole), rows (any), or rows:4,6,21 (these)
    #[cfg_attr(feature = "command", arg(long, value_name = "WHAT", default_value = SENSIBLE))]
    pub allow: Permission,
    /// List at most N sets of rows that can be eliminated without a change of the motion
    #[cfg_attr(feature = "command", arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "100"))]
    pub eliminations: Option<usize>,
    /// Also judge the components in the frames of the first body, of the edge and of the joint
    #[cfg_attr(feature = "command", arg(long))]
    pub frames: bool,
    /// Also judge moments about this point: X,Y in the plane, X,Y,Z in space (m, ground axes), or
    /// the name of a marker
    #[cfg_attr(
        feature = "command",
        arg(long, value_name = "POINT", allow_hyphen_values = true)
    )]
    pub about: Option<String>,
    /// Run the motion, for the duration that the scene states or to T_END (s): the verdict that
    /// holds along it, and the intervals with other verdicts
    #[cfg_attr(feature = "command", arg(long, value_name = "T_END", num_args = 0..=1, default_missing_value = STATED, allow_negative_numbers = true))]
    pub along: Option<Along>,
    /// Compute the reactions for a choice: minimum-norm, minimum-norm:length=L (a torque counts as
    /// a force on an arm of length L), compliance:W3=1e-6,W4=2e-6 (m/N; NAME=M/R adds rad/(N·m)),
    /// drop:6,21; may be given several times
    #[cfg_attr(feature = "command", arg(long, value_name = "CHOICE"))]
    pub choose: Vec<String>,
}

const SENSIBLE: &str = "sensible";

/// What may be deleted, as `sensible` or `rows:4,6,21`.
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

/// How far the motion is judged.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(try_from = "TimeOrWord")]
pub enum Along {
    /// As far as the scene states.
    Stated,
    /// To this time (s).
    To(f64),
}

impl FromStr for Along {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.parse() {
            _ if text == STATED => Ok(Self::Stated),
            Ok(time) => Ok(Self::To(time)),
            Err(_) => Err(format!("`{text}` is no time, need one > 0 (s)")),
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
