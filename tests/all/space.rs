//! Mechanisms of space: verdicts and motions with known answers.

mod adams;
mod bushing;
mod catalogue;
mod drifts;
mod gears;
mod motion;
mod rolling;
mod second_order;
mod shafts;
mod starts;
mod turns;
mod verdicts;
