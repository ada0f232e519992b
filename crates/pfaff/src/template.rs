//! Templates for scenes: the scenes of `examples/`, which have their own tests.

/// Longest summary (bytes).
const WIDTH: usize = 96;

/// A scene that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Template {
    name: &'static str,
    text: &'static str,
}

macro_rules! examples {
    ($($name:literal)*) => {
        [$(Template {
            name: $name,
            text: include_str!(concat!(env!("PFAFF_EXAMPLES"), "/", $name, ".toml")),
        }),*]
    };
}

/// The list starts with simple scenes and ends with scenes that use many features.
/// `examples/README.md` lists the templates by kind.
const EXAMPLES: [Template; 33] = examples!(
    "door" "carriage" "truss" "four-bar" "slider-crank" "knife-edge" "sleigh" "towed-cart" "scotch-yoke" "three-cranks" "gear-train" "planetary-gear"
    "sweeper" "car" "truck" "snakeboard" "pantograph" "peaucellier" "chebyshev" "five-bar" "scissor-lift" "andrews"
    "hinges" "table" "wagon" "robot-in-space" "linkage" "hooke" "sarrus" "bricard" "bennett" "hexapod" "top"
);

const ROBOT: Template = Template {
    name: "robot-trolley",
    text: include_str!(env!("PFAFF_ROBOT")),
};

impl Template {
    /// All templates.
    pub const ALL: &'static [Self] = &{
        let mut all = [ROBOT; EXAMPLES.len() + 1];
        let mut k = 0;
        while k < EXAMPLES.len() {
            all[k] = EXAMPLES[k];
            k += 1;
        }
        all
    };

    /// Returns the name of the template.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.name
    }

    /// Returns the text of the scene.
    #[must_use]
    pub fn text(self) -> &'static str {
        self.text
    }

    /// Returns the first sentence of the text, which describes the template.
    #[must_use]
    pub fn summary(self) -> String {
        let lines = self.text.lines().map_while(|line| line.strip_prefix("# "));
        let words = lines.collect::<Vec<_>>().join(" ");
        let end = words
            .find(". ")
            .unwrap_or(words.trim_end_matches('.').len());
        let sentence = &words[..end];
        if sentence.len() <= WIDTH {
            return sentence.to_owned();
        }
        let end = sentence[..sentence.floor_char_boundary(WIDTH)].rfind([' ', ',']);
        format!(
            "{} …",
            sentence[..end.unwrap_or(0)].trim_end_matches([',', ':'])
        )
    }

    /// Returns the scene with a header that explains its use. `file` is the file name in the
    /// header.
    #[must_use]
    pub fn scene(self, file: &str) -> String {
        let Self { name, text } = self;
        format!(
            "# Begun with `pfaff new {name}`. What to do with it:
#   pfaff check {file} --watch      every problem of the file, whenever it is saved
#   pfaff view {file}               a picture
#   pfaff analyze {file}            which reactions are unique, and why others are not
#   pfaff simulate {file} --out run
# For help while writing (Taplo, Even Better TOML): `pfaff schema > pfaff.schema.json`, and as the first line here
#   #:schema ./pfaff.schema.json

{text}"
        )
    }
}
