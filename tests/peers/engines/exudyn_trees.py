"""Exudyn in joint coordinates: one kinematic tree for each hinge of the ground.

Loops are closed by the rows that a user would keep. Hinges are the only supported joints.
"""

from __future__ import annotations

import exudyn as exu
import exudyn.itemInterface as item
import numpy as np

from mechanism import GROUND, Array, Joint, Mechanism, perpendicular

Placed = tuple[int, int, Array, Array]
"""Object and number of a link, its axes and its origin at the start."""


def axes_of(joint: Joint) -> Array:
    """Returns the frame of a hinge at the start, with z along its axis."""
    return np.column_stack([*perpendicular(joint.axis), joint.axis])


class Trees:
    """The model of a mechanism, with sensors at the watched points."""

    def __init__(self, mechanism: Mechanism) -> None:
        """Builds the model."""
        self.mechanism = mechanism
        self.container = exu.SystemContainer()
        self.mbs = self.container.AddSystem()
        self.ground = self.mbs.AddObject(item.ObjectGround())
        self.links: dict[int, Placed] = {}
        for joint in mechanism.tree_joints():
            if joint.first == GROUND:
                self.add([joint, *self.below(joint.second)])
        for joint in mechanism.closing_joints():
            self.close(joint)
        self.sensors = [self.sensor(body, offset) for body, offset in mechanism.watched]
        self.mbs.Assemble()

    def below(self, body: int) -> list[Joint]:
        """Returns the joints that follow a body in the tree, in order."""
        found = []
        for joint in self.mechanism.tree_joints():
            if joint.first == body:
                found += [joint, *self.below(joint.second)]
        return found

    def add(self, joints: list[Joint]) -> None:
        """Adds one tree."""
        frames = {GROUND: (np.eye(3), np.zeros(3))}
        number = {joint.second: k for k, joint in enumerate(joints)}
        turns, offsets, tensors, centres = [], [], [], []
        for joint in joints:
            parent, origin = frames[joint.first]
            own = axes_of(joint)
            frames[joint.second] = (own, joint.at)
            body = self.mechanism.bodies[joint.second]
            turns.append(parent.T @ own)
            offsets.append(parent.T @ (joint.at - origin))
            tensors.append(own.T @ body.tensor @ own)
            centres.append(own.T @ (body.centre - joint.at))
        zero = [0.0] * len(joints)
        node = self.mbs.AddNode(
            item.NodeGenericODE2(
                referenceCoordinates=zero,
                initialCoordinates=zero,
                initialCoordinates_t=[
                    float(self.mechanism.relative_spin(joint) @ joint.axis) for joint in joints
                ],
                numberOfODE2Coordinates=len(joints),
            )
        )
        tree = self.mbs.AddObject(
            item.ObjectKinematicTree(
                nodeNumber=node,
                jointTypes=[exu.JointType.RevoluteZ] * len(joints),
                linkParents=[number.get(joint.first, -1) for joint in joints],
                jointTransformations=exu.Matrix3DList(turns),
                jointOffsets=exu.Vector3DList(offsets),
                linkInertiasCOM=exu.Matrix3DList(tensors),
                linkCOMs=exu.Vector3DList(centres),
                linkMasses=[self.mechanism.bodies[joint.second].mass for joint in joints],
                gravity=list(self.mechanism.gravity),
            )
        )
        for joint in joints:
            self.links[joint.second] = (tree, number[joint.second], *frames[joint.second])

    def close(self, joint: Joint) -> None:
        """Closes a loop."""
        markers, turns = [], []
        for body in (joint.first, joint.second):
            if body == GROUND:
                place = list(joint.at)
                marker = item.MarkerBodyRigid(bodyNumber=self.ground, localPosition=place)
                turns.append(axes_of(joint))
            else:
                tree, link, axes, origin = self.links[body]
                marker = item.MarkerKinematicTreeRigid(
                    objectNumber=tree,
                    linkNumber=link,
                    localPosition=list(axes.T @ (joint.at - origin)),
                )
                turns.append(axes.T @ axes_of(joint))
            markers.append(self.mbs.AddMarker(marker))
        self.mbs.AddObject(
            item.ObjectJointGeneric(
                markerNumbers=markers,
                constrainedAxes=list(joint.rows),
                rotationMarker0=turns[0],
                rotationMarker1=turns[1],
            )
        )

    def sensor(self, body: int, offset: Array) -> int:
        """Adds a sensor at a point of a body."""
        tree, link, axes, origin = self.links[body]
        place = axes.T @ (self.mechanism.centre(body) + offset - origin)
        return self.mbs.AddSensor(
            item.SensorKinematicTree(
                objectNumber=tree,
                linkNumber=link,
                localPosition=list(place),
                storeInternal=True,
                outputVariableType=exu.OutputVariableType.Position,
            )
        )
