"""Exudyn: redundant or joint coordinates, implicit generalised-alpha, one C++ call for each run.

Options: `rows` ("all": every row of every joint, the solver ignores the singular Jacobian; "kept":
the redundant rows of closing joints are removed by hand), `solver` ("dense" or "sparse"), `method`
("ga" for index 3 with the given `radius`, "ga2" for index 2, "trapezoid"), `rotation` ("euler",
"quaternion" or "vector"), `newton` ("modified" or "full"), `coordinates` ("trees" for joint
coordinates instead of redundant ones). Planar scenes have planar bodies.
"""

from __future__ import annotations

import time

import exudyn as exu
import exudyn.itemInterface as item
import numpy as np
from exudyn.utilities import RigidBodyInertia

from exudyn_trees import Trees
from mechanism import GROUND, Array, Joint, Mechanism, perpendicular
from outcome import Outcome, Run

NODES = {
    "quaternion": exu.NodeType.RotationEulerParameters,
    "euler": exu.NodeType.RotationRxyz,
    "vector": exu.NodeType.RotationRotationVector,
}
SOLVERS = {"dense": exu.LinearSolverType.EigenDense, "sparse": exu.LinearSolverType.EigenSparse}


def version() -> str:
    """Returns the version of the package."""
    return exu.__version__


class System:
    """The model of a mechanism, with sensors at the watched points."""

    def __init__(self, mechanism: Mechanism, options: dict) -> None:
        """Builds the model."""
        self.mechanism, self.options = mechanism, options
        self.container = exu.SystemContainer()
        self.mbs = self.container.AddSystem()
        self.ground = self.mbs.AddObject(item.ObjectGround())
        add = self.add_planar if mechanism.planar else self.add_body
        self.bodies = [add(k) for k in range(len(mechanism.bodies))]
        for joint in mechanism.joints:
            if mechanism.planar:
                self.join_in_plane(joint)
            else:
                self.join(joint)
        self.sensors = [
            self.mbs.AddSensor(
                item.SensorBody(
                    bodyNumber=self.bodies[k],
                    localPosition=list(offset),
                    storeInternal=True,
                    outputVariableType=exu.OutputVariableType.Position,
                )
            )
            for k, offset in mechanism.watched
        ]
        self.mbs.Assemble()

    def add_planar(self, index: int) -> int:
        """Adds a body in the plane."""
        body = self.mechanism.bodies[index]
        node = self.mbs.AddNode(
            item.NodeRigidBody2D(
                referenceCoordinates=[*body.centre[:2], 0.0],
                initialVelocities=[*body.velocity[:2], body.angular_velocity[2]],
            )
        )
        made = self.mbs.AddObject(
            item.ObjectRigidBody2D(mass=body.mass, inertia=body.tensor[2, 2], nodeNumber=node)
        )
        marker = self.mbs.AddMarker(item.MarkerBodyMass(bodyNumber=made))
        gravity = list(self.mechanism.gravity)
        self.mbs.AddLoad(item.LoadMassProportional(markerNumber=marker, loadVector=gravity))
        return made

    def add_body(self, index: int) -> int:
        """Adds a body in space."""
        body = self.mechanism.bodies[index]
        return self.mbs.CreateRigidBody(
            referencePosition=list(body.centre),
            initialVelocity=list(body.velocity),
            initialAngularVelocity=list(body.angular_velocity),
            inertia=RigidBodyInertia(mass=body.mass, inertiaTensor=body.tensor),
            gravity=list(self.mechanism.gravity),
            nodeType=NODES[self.options.get("rotation", "euler")],
        )

    def owner(self, index: int) -> int:
        """Returns the object of a body."""
        return self.ground if index == GROUND else self.bodies[index]

    def markers(self, joint: Joint, kind: type) -> list[int]:
        """Returns markers of a joint on its two bodies."""
        return [
            self.mbs.AddMarker(
                kind(
                    bodyNumber=self.owner(k),
                    localPosition=list(joint.at - self.mechanism.centre(k)),
                )
            )
            for k in (joint.first, joint.second)
        ]

    def join_in_plane(self, joint: Joint) -> None:
        """Adds a hinge in the plane, or one row of it if the other rows are removed by hand."""
        markers = self.markers(joint, item.MarkerBodyPosition)
        if joint.closes and self.options.get("rows") == "kept" and joint.rows[:2] != (1, 1):
            self.mbs.AddObject(
                item.ObjectJointSpherical(
                    markerNumbers=markers, constrainedAxes=[*joint.rows[:2], 0]
                )
            )
            return
        self.mbs.AddObject(item.ObjectJointRevolute2D(markerNumbers=markers))

    def join(self, joint: Joint) -> None:
        """Adds a joint in space; the generic joint is used if rows are omitted."""
        markers = self.markers(joint, item.MarkerBodyRigid)
        kept = joint.closes and self.options.get("rows") == "kept"
        if joint.kind == "spherical":
            self.mbs.AddObject(item.ObjectJointSpherical(markerNumbers=markers))
            return
        rows, turn = [1, 1, 1, 1, 1, 0], np.eye(3)
        if joint.kind == "prismatic":
            rows = [1, 1, 0, 1, 1, 1]
            turn = np.column_stack([*perpendicular(joint.axis), joint.axis])
        elif joint.kind == "universal":
            # The joint is free about the first axis in the first body and the second axis in the
            # second.
            rows = [1, 1, 1, 0, 0, 1]
            turn = np.column_stack([joint.axis, joint.cross, np.cross(joint.axis, joint.cross)])
        else:
            turn = np.column_stack([*perpendicular(joint.axis), joint.axis])
            rows = list(joint.rows) if kept else rows
        if joint.kind == "revolute" and rows == [1, 1, 1, 1, 1, 0]:
            self.mbs.AddObject(
                item.ObjectJointRevoluteZ(
                    markerNumbers=markers, rotationMarker0=turn, rotationMarker1=turn
                )
            )
            return
        self.mbs.AddObject(
            item.ObjectJointGeneric(
                markerNumbers=markers,
                constrainedAxes=rows,
                rotationMarker0=turn,
                rotationMarker1=turn,
            )
        )


def settings(mechanism: Mechanism, options: dict, steps: int) -> exu.SimulationSettings:
    """Returns the settings of a run; no file is written."""
    made = exu.SimulationSettings()
    made.timeIntegration.numberOfSteps = steps
    made.timeIntegration.endTime = mechanism.duration
    made.timeIntegration.verboseMode = 0
    made.timeIntegration.generalizedAlpha.spectralRadius = options.get("radius", 0.9)
    made.timeIntegration.newton.useModifiedNewton = options.get("newton", "full") == "modified"
    if options.get("method") == "ga2":
        made.timeIntegration.generalizedAlpha.useIndex2Constraints = True
        made.timeIntegration.generalizedAlpha.useNewmark = True
    made.solution.file.write = False
    made.solution.sensors.writePeriod = mechanism.interval
    made.linearSolver.ignoreSingularJacobian = options.get("rows") == "all"
    made.linearSolver.solverType = SOLVERS[options.get("solver", "sparse")]
    made.parallel.numberOfThreads = 1
    return made


def read(system: System | Trees, sensors: list[int], mechanism: Mechanism) -> Array:
    """Reads the positions at the instants of comparison."""
    tables = [np.atleast_2d(system.mbs.GetSensorStoredData(sensor)) for sensor in sensors]
    wanted = mechanism.times
    rows = []
    for time_wanted in wanted:
        near = [table[np.argmin(np.abs(table[:, 0] - time_wanted))] for table in tables]
        if abs(near[0][0] - time_wanted) > 1e-6:
            break
        rows.append([row[1:4] for row in near])
    return np.array(rows)


def prepare(mechanism: Mechanism, options: dict, step: float) -> Run:
    """Prepares a run with steps of about `step`, a whole number of steps between instants."""
    trees = options.get("coordinates") == "trees"
    system = Trees(mechanism) if trees else System(mechanism, options)
    steps = mechanism.samples * max(1, round(mechanism.interval / step))
    chosen = settings(mechanism, options, steps)
    scheme = exu.DynamicSolverType.GeneralizedAlpha
    if options.get("method") == "trapezoid":
        scheme = exu.DynamicSolverType.TrapezoidalIndex2

    def run() -> Outcome:
        note = ""
        begin = time.perf_counter()
        try:
            system.mbs.SolveDynamic(chosen, solverType=scheme)
        except Exception as error:  # the solver stopped; the reached instants count
            note = " ".join(str(error).split())[:160] or type(error).__name__
        seconds = time.perf_counter() - begin
        return Outcome(read(system, system.sensors, mechanism), seconds, note=note)

    return run
