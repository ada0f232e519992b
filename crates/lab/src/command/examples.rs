//! Examples that are printed at the end of `--help`.

pub(super) const STRESS: &str = "Examples:
  lab stress --list                                the families of cases
  lab stress --out stress                          all of them
  lab stress --family trivial --out stress         one; may be given several times

Each case has its right answer. Exit code 1 if something is silently wrong, or refused although there is an answer. Build with --release.";

pub(super) const GENERATE: &str = "Examples:
  lab generate parallelograms --n 9000 --out chain.toml    48 000 revolutes, 6000 redundant rows
  lab generate random --n 100 --seed 7 | pfaff analyze -

Kinds, and what n counts:
  n-four-bar       loops of unit rods in a row, one freedom
  parallelograms   cells of a chain; with three cranks they are redundant (--redundant, two thirds of them)
  lattice          cells along each side of a square grid that hangs from a corner; blocks along its diagonal are braced
                   (--redundant, all of them)
  fleet            robots with trolleys side by side
  random           modules, each on an earlier body; some are doubled (--redundant, a third of them)

Ranks, redundancy and what is not unique are known, and stand at the head of the file. Same words, same bytes.";

pub(super) const WORK_PRECISION: &str = "Examples:
  lab work-precision --out wp                      the suite: scenes whose motion is known
  lab work-precision andrews sleigh --out wp       two of them
  lab work-precision mine.toml --out wp --quick    a scene of your own; two methods that agree are its reference

Build with --release, and keep the machine idle: seconds are compared.";

pub(super) const FUZZ: &str = "Examples:
  lab fuzz run --inputs 100000 --seed 1              what fails is made short and kept in found/
  lab fuzz run --inputs 100000 --suite space         the same in space
  lab fuzz exact                                     20 000 degenerate scenes, judged by exact arithmetic
  lab fuzz exact --suite space                       mechanisms in space, judged in the same way
  lab fuzz exact --suite lifted                      scenes of the plane, lifted into space
  lab fuzz rounded --drawings 1000                   data with 3 to 16 digits; in space with --suite space
  lab fuzz full-rank --drawings 2000                 full rank near a lower one
  lab fuzz numbers --scenes 1000                     reactions on random motions, compared with other solutions

Exit code 1 if one of them fails.";
