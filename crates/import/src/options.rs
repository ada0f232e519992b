//! How a file is imported.

use crate::axes::Axes;
use crate::files::Folder;

/// How a file is imported.
#[derive(Clone, Debug)]
pub struct Options {
    /// Where included files are.
    pub folder: Folder,
    /// Whether links that are fixed to others stay bodies of their own.
    pub fixed: FixedLinks,
    /// What becomes of the root link of a URDF.
    pub base: Base,
    /// A file of loop closures of a URDF: its name and its text.
    pub loops: Option<(String, String)>,
    /// Values of coordinates of joints near which loops are closed: name of the joint and value (m
    /// or rad), in the file's sense of the coordinate.
    pub pose: Vec<(String, f64)>,
    /// What is done with axes that nearly are parallel or meet.
    pub axes: Axes,
    /// The keyframe at which the scene starts; without it, where the file describes the links.
    pub keyframe: Option<String>,
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
        }
    }
}

/// What becomes of links that are fixed to others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FixedLinks {
    /// They are parts of the others, and markers there.
    Merged,
    /// They are bodies with a `fixed` joint.
    Kept,
}

/// What becomes of the root link of a URDF, of which the format says nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// It is fixed to the ground.
    Fixed,
    /// It is free.
    Free,
}

impl Base {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Fixed, Self::Free];

    /// Its name on a command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Free => "free",
        }
    }
}
