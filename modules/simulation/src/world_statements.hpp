// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/simulation/world.hpp"
#include "statement.hpp"

namespace colonnade {

/// The materials every world has, its floor and its ceiling.
void addBuiltInMaterials(World& world);

/// Index of the material a key names; fails where there is none of this name.
std::size_t materialOf(Statement& s, const World& world, const char* key, const char* otherwise);

/// What one statement of a world file does; each throws Error naming file and line.
void readMaterial(Statement& s, World& world);
void readWall(Statement& s, World& world);
void readRoom(Statement& s, World& world);
void readDoor(Statement& s, World& world);
void readPilaster(Statement& s, World& world);
void readPillar(Statement& s, World& world);
void readColumn(Statement& s, World& world);
void readTable(Statement& s, World& world);
void readChair(Statement& s, World& world);
void readCabinet(Statement& s, World& world);
void readBin(Statement& s, World& world);
void readBoard(Statement& s, World& world);
void readLamp(Statement& s, World& world);
void readWalker(Statement& s, World& world);
void readFloor(Statement& s, World& world);
void readCeiling(Statement& s, World& world);
void readTexture(Statement& s, World& world);
void readStart(Statement& s, World& world);
void readDrive(Statement& s, World& world);
void readRobot(Statement& s, World& world);
void readTurn(Statement& s, World& world);
void readWait(Statement& s, World& world);
void readCamera(Statement& s, World& world);
void readMono(Statement& s, World& world);
void readLight(Statement& s, World& world);
void readDepth(Statement& s, World& world);
void readColour(Statement& s, World& world);
void readOdometry(Statement& s, World& world);

}  // namespace colonnade
