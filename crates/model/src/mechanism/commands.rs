//! Evaluates the controllers of a mechanism. A controller receives the state of the whole mechanism
//! and is called once for each evaluation of the applied forces.
//!
//! The values of a controller are arguments of kernels, in addition to poses, velocities and
//! functions of time. They are stored with the evaluation ([`Scratch`]). Therefore a value never
//! belongs to another state than the poses that are evaluated with it.

use super::Mechanism;
use crate::called::{BodyState, Commands, ControlState, Controller, DriveState, Efforts};
use crate::law::UndefinedValue;
use crate::system::Scratch;

impl Mechanism {
    /// Returns the joint coordinates and rates of the drives with force laws and of the springs on
    /// joint coordinates, at the configuration and the velocities in the work space, in the order
    /// of the forces.
    pub fn drive_states(&self, s: &Scratch) -> impl Iterator<Item = DriveState> {
        let forces = self.elements.forces.iter();
        forces.filter_map(|force| {
            let found = force.drive(&s.slots)?;
            Some(DriveState {
                time: s.t,
                measure: found.measure,
                rate: found.rate,
            })
        })
    }

    /// Returns the states of the centres of mass of all bodies, at the configuration in the work
    /// space and at velocities v.
    ///
    /// # Panics
    /// Panics if v has the wrong length.
    pub fn body_states(&self, s: &Scratch, v: &[f64]) -> impl Iterator<Item = BodyState> {
        let space = self.space();
        (0..self.bodies.len()).map(move |body| {
            let v = &v[space.columns_of(body)];
            let (mut velocity, mut own) = ([0.0; 3], [0.0; 3]);
            velocity[space.forces()].copy_from_slice(&v[space.forces()]);
            for k in space.torques() {
                own[space.axis_of(k)] = v[k];
            }
            let axes = s.bodies.axes(body);
            let principal = self.bodies[body].principal.as_ref();
            let axes = principal.map_or(axes, |principal| principal.framed(axes));
            BodyState {
                time: s.t,
                position: s.bodies.origin(body),
                rotation: [0, 1, 2].map(|row| axes.map(|axis| axis[row])),
                angle: s.bodies.angle(body),
                velocity,
                angular_velocity: s.bodies.turned(body, own),
            }
        })
    }

    /// Returns storage for the values of the controllers.
    pub(super) fn commands(&self) -> Commands {
        let controllers = &self.elements.controllers;
        let n = if controllers.is_empty() {
            0
        } else {
            self.layout.n_q + self.layout.n_v
        };
        Commands {
            state: vec![0.0; n],
            efforts: controllers.iter().map(Controller::efforts).collect(),
            ..Commands::default()
        }
    }

    /// Calls the controllers at the state in the work space, unless their values are known there.
    pub(crate) fn command(&self, s: &mut Scratch) {
        if s.slots.commands.state.is_empty() || s.slots.commands.are_known {
            return;
        }
        let mut commands = self.stated(s);
        commands.are_known = true;
        let mut places = self.elements.signals.iter();
        let mut efforts = std::mem::take(&mut commands.efforts);
        for (controller, own) in self.elements.controllers.iter().zip(&mut efforts) {
            let is_known = self.call(controller, &commands, s.t, own).is_ok();
            for (value, &place) in own.values(self.space()).zip(&mut places) {
                s.slots.jets[place][0] = if is_known { value } else { f64::NAN };
            }
        }
        commands.efforts = efforts;
        s.slots.commands = commands;
    }

    /// Returns the reason why a controller has no values at the state in the work space, if there
    /// is such a reason.
    pub(super) fn uncommanded(&self, s: &mut Scratch) -> Option<UndefinedValue> {
        let commands = self.stated(s);
        let all = self.elements.controllers.iter();
        let mut called = all.map(|controller| {
            let mut own = controller.efforts();
            self.call(controller, &commands, s.t, &mut own).err()
        });
        let found = called.find_map(|why| why);
        s.slots.commands = commands;
        found
    }

    /// Sets coordinates or velocities of the state, which starts at index `first` of the state, and
    /// forgets the values of the controllers.
    #[inline]
    pub(super) fn set_state(&self, s: &mut Scratch, first: usize, x: &[f64]) {
        let commands = &mut s.slots.commands;
        let Some(known) = commands.state.get_mut(first..first + x.len()) else {
            return;
        };
        known.copy_from_slice(x);
        commands.are_known = false;
        for &place in &self.elements.signals {
            s.slots.jets[place][0] = f64::NAN;
        }
    }

    /// Takes the commands out of the work space, with the states of drives and bodies.
    fn stated(&self, s: &mut Scratch) -> Commands {
        let mut commands = std::mem::take(&mut s.slots.commands);
        commands.drives.clear();
        commands.drives.extend(self.drive_states(s));
        commands.bodies.clear();
        let v = &commands.state[self.layout.n_q..];
        commands.bodies.extend(self.body_states(s, v));
        commands
    }

    fn call(
        &self,
        controller: &Controller,
        commands: &Commands,
        time: f64,
        efforts: &mut Efforts,
    ) -> Result<(), UndefinedValue> {
        let (q, v) = commands.state.split_at(self.layout.n_q);
        let state = ControlState {
            time,
            q,
            v,
            drives: &commands.drives,
            bodies: &commands.bodies,
        };
        controller.call(&state, efforts)
    }
}
