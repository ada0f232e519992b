//! Mechanisms in space: verdicts and motions with known answers.

mod adams;
mod axles;
mod bicycle;
mod bushing;
mod catalogue;
mod choices;
mod drifts;
mod gearbox;
mod gears;
mod motion;
mod robot;
mod rods;
mod rolling;
mod second_order;
mod shafts;
mod starts;
mod turns;
mod verdicts;
