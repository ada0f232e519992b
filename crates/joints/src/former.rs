//! Scene types that there were, for readers of older files.

/// A scene type that is no longer one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FormerType {
    /// Its name.
    pub name: &'static str,
    /// The scene type in which it is contained now.
    pub now: &'static str,
    /// What to write instead.
    pub advice: &'static str,
}

/// All of them.
pub const FORMER_TYPES: [FormerType; 2] = {
    let contact = FormerType {
        name: "wheel-contact",
        now: "wheel",
        advice: "write one joint `wheel` for a `wheel-contact` and its `wheel-slip`: it has the rows of both",
    };
    [
        contact,
        FormerType {
            name: "wheel-slip",
            ..contact
        },
    ]
};
