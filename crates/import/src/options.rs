//! Options of an import.

use crate::axes::Axes;
use crate::files::Folder;

/// Options of an import.
#[derive(Clone, Debug)]
pub struct Options {
    /// Folder of included files.
    pub folder: Folder,
    /// Whether links that are fixed to other links remain separate bodies.
    pub fixed: FixedLinks,
    /// Treatment of the root link of a URDF.
    pub base: Base,
    /// The name and the text of a file of loop closures of a URDF.
    pub loops: Option<(String, String)>,
    /// Values of joint coordinates. Loops are closed near these values. Each entry is the name of
    /// the joint, and the value (m or rad) with the sign convention of the file.
    pub pose: Vec<(String, f64)>,
    /// Treatment of axes that are nearly parallel or nearly intersect.
    pub axes: Axes,
    /// The keyframe at which the scene starts. Without a keyframe, the scene starts at the
    /// described pose.
    pub keyframe: Option<String>,
    /// The only model of an SDF file that is read. Without a name, all models are read.
    pub model: Option<String>,
    /// Drives from the actuators of the file.
    pub drives: Drives,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            folder: Folder::None,
            fixed: FixedLinks::Merged,
            base: Base::Fixed,
            loops: None,
            pose: Vec::new(),
            axes: Axes::Told,
            keyframe: None,
            model: None,
            drives: Drives::None,
        }
    }
}

/// Treatment of links that are fixed to other links.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FixedLinks {
    /// The links are merged into the other links and become markers.
    Merged,
    /// The links are bodies with a `fixed` joint.
    Kept,
}

/// Treatment of the root link of a URDF, which the format does not define.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// The root link is fixed to the ground.
    Fixed,
    /// The root link is free.
    Free,
}

impl Base {
    /// Both values.
    pub const ALL: [Self; 2] = [Self::Fixed, Self::Free];

    /// Name on a command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Free => "free",
        }
    }
}

/// Drives from the actuators of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drives {
    /// Actuators are omitted and reported.
    None,
    /// Each actuated joint coordinate has a drive with a torque or force of zero.
    Torque,
    /// Each actuated joint coordinate has a drive that locks it.
    Position,
}

impl Drives {
    /// All values.
    pub const ALL: [Self; 3] = [Self::None, Self::Torque, Self::Position];

    /// Name on a command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Torque => "torque",
            Self::Position => "position",
        }
    }
}
