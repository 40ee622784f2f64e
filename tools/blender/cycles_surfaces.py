# SPDX-License-Identifier: Apache-2.0
"""Surfaces as meshes."""


def add(scene, name, description, directory):
    raise NotImplementedError(name)
