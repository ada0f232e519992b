//! Examples that are printed at the end of `--help`.

pub(super) const SCHEMA: &str = "Examples:
  pfaff schema > pfaff.schema.json
  pfaff schema analyze    schema of `pfaff analyze --json`

Editors with Taplo (Even Better TOML in VS Code, or `taplo lsp`) use the schema
if the scene begins with this line and the schema file is in the same directory:
  #:schema ./pfaff.schema.json

The editor then completes, explains and checks keys and types. Use
`pfaff check --watch` for the other errors (names, rows, assembly).";

pub(super) const NEW: &str = "Examples:
  pfaff new              list the templates
  pfaff new four-bar     write four-bar.toml
  pfaff new robot-trolley --out mine.toml
  pfaff new door --out - | pfaff analyze -

Existing files are not overwritten without --force.";

pub(super) const IMPORT: &str = "Examples:
  pfaff import humanoid.xml --out humanoid.toml
  pfaff import arm.xml --out arm.toml --keyframe home
  pfaff import arm.xml --out - | pfaff analyze -

Elements that a scene cannot express are omitted. The answer and the head of the
scene list them, with the lines of the model file.";

pub(super) const VIEW: &str = "Examples:
  pfaff view robot-trolley.toml          write robot-trolley.html and open it
  pfaff view robot-trolley.toml --png    write robot-trolley.png
  pfaff view robot-trolley.toml --out picture.svg --no-open
  pfaff view robot-trolley.toml --out large.png --scale 4

The picture shows the assembled start. The fill of a joint shows its verdict; the
label shows its rows. Bodies are drawn through their joints, since a scene
contains no shapes.";

pub(super) const COMPLETIONS: &str = "Examples:
  pfaff completions bash > ~/.local/share/bash-completion/completions/pfaff
  pfaff completions zsh > ~/.zfunc/_pfaff
  pfaff completions fish > ~/.config/fish/completions/pfaff.fish
  pfaff completions powershell >> $PROFILE";

pub(super) const MAN: &str = "Examples:
  pfaff man | man -l -
  pfaff man analyze | man -l -    page of one command
  pfaff man > ~/.local/share/man/man1/pfaff.1";

pub(super) const EXPLAIN: &str = "\
Examples:
  pfaff explain P0102    explain one code
  pfaff explain          list all codes";
