//! Examples at the end of `--help`.

pub(super) const SCHEMA: &str = "Examples:
  pfaff schema > pfaff.schema.json
  pfaff schema analyze                          keys of the document of `pfaff analyze --json`

Editors with Taplo (Even Better TOML in VS Code, taplo lsp elsewhere) read it where this is the first line of a scene beside it:
  #:schema ./pfaff.schema.json

Then keys and types are completed, explained and checked while one writes. What only the whole scene can tell (names, rows, a start that assembles) is for
`pfaff check --watch`.";

pub(super) const NEW: &str = "Examples:
  pfaff new                                     the templates
  pfaff new four-bar                            writes four-bar.toml
  pfaff new robot-trolley --out mine.toml
  pfaff new door --out - | pfaff analyze -

A file that is there already is not touched without --force.";

pub(super) const IMPORT: &str = "Examples:
  pfaff import humanoid.xml --out humanoid.toml        and what the scene lacks, with lines of the file
  pfaff import arm.xml --out arm.toml --keyframe home  starts at a keyframe of the file
  pfaff import arm.xml --out - | pfaff analyze -

What a scene cannot express is not invented: it stands at the head of the scene, and in the answer.";

pub(super) const VIEW: &str = "Examples:
  pfaff view robot-trolley.toml                 writes the page robot-trolley.html and opens it
  pfaff view robot-trolley.toml --out picture.svg --no-open
  pfaff view robot-trolley.toml --png           writes robot-trolley.png, for a mail, slides or a report
  pfaff view robot-trolley.toml --out large.png --scale 4

The start is assembled first. Joints are filled by the verdict of their reactions, and named with their rows. Bodies are drawn through their joints: a scene does not
tell their shapes.";

pub(super) const COMPLETIONS: &str = "Examples:
  pfaff completions bash > ~/.local/share/bash-completion/completions/pfaff
  pfaff completions zsh > ~/.zfunc/_pfaff
  pfaff completions fish > ~/.config/fish/completions/pfaff.fish
  pfaff completions powershell >> $PROFILE";

pub(super) const MAN: &str = "Examples:
  pfaff man | man -l -
  pfaff man analyze | man -l -                  of one command
  pfaff man > ~/.local/share/man/man1/pfaff.1";

pub(super) const EXPLAIN: &str = "\
Examples:
  pfaff explain P0102     one code
  pfaff explain           all codes";
