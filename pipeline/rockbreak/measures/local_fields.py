"""Fields for figures: means over square windows that move across an assembly.

    fields = windows(frame)                                   # once for a frame
    fields.void_ratio, fields.stress(frame_stresses(frame)), fields.mean(rotations_since(frame, start))
    axes.pcolormesh(fields.x, fields.y, fields.void_ratio)    # x, y: centres of the windows
"""
from dataclasses import dataclass

import numpy as np

from .void_ratio import TileAreas, tile_areas


@dataclass(frozen=True)
class Windows:
    """Windows of K x K tiles, one around each (x, y); values are nan where a window is not wholly inside the ring."""
    x: np.ndarray        # centres [m]
    y: np.ndarray
    size: float          # of a window's side [m]
    tiles: TileAreas     # of the particles
    shape: tuple         # of the grid of tiles (rows along y, columns along x)
    across: int          # K
    inside: np.ndarray   # len(y) x len(x) bool

    def _sums(self, per_pair):
        """len(y) x len(x) sums over windows of values per pair of a particle and a tile."""
        rows, columns = self.shape
        total = np.zeros((rows + 1, columns + 1))
        total[1:, 1:] = np.bincount(self.tiles.row * columns + self.tiles.column, per_pair, rows * columns).reshape(
            self.shape)
        total = total.cumsum(axis=0).cumsum(axis=1)
        k = self.across
        return np.where(self.inside, total[k:, k:] - total[:-k, k:] - total[k:, :-k] + total[:-k, :-k], np.nan)

    @property
    def solids(self):
        """Solid area in each window [m^2], overlaps counted twice."""
        return self._sums(self.tiles.area)

    @property
    def void_ratio(self):
        """Window / solids - 1: e1 of the window."""
        with np.errstate(divide="ignore"):
            return self.size ** 2 / self.solids - 1

    def mean(self, values):
        """Mean of N particles' values, weighted by the area that each has in a window. nan does not count."""
        per_pair = np.asarray(values, dtype=float)[self.tiles.polygon]
        known = np.isfinite(per_pair)
        with np.errstate(invalid="ignore", divide="ignore"):
            return (self._sums(np.where(known, per_pair, 0.0) * self.tiles.area)
                    / self._sums(np.where(known, self.tiles.area, 0.0)))

    def stress(self, stress):
        """len(y) x len(x) x 3 mean stress of the windows, voids (stress 0) included; of N x 3 of particles [Pa]."""
        return np.stack([self._sums(component[self.tiles.polygon] * self.tiles.area)
                         for component in np.asarray(stress).T], axis=-1) / self.size ** 2


def windows(frame, size=None, across=4):
    """Windows of a Frame, of side `size` [m] (None: four mean equivalent diameters of the originals), a centre every
    size / `across`.

    Smaller windows scatter more: with n particles in a window, the void ratio by about 1 / n of itself and more.
    """
    if size is None:
        size = 4 * float(np.sqrt(4 * frame.area.sum() / np.pi / len(np.unique(frame.root))))
    return windows_of(frame.vertices, frame.offset, frame.position[frame.ring], size, across)


def windows_of(vertices, offset, ring, size, across=4):
    """Windows over outlines (V x 2, first rows N + 1) within a polygon `ring` (B x 2, counter-clockwise) [m]."""
    tile = size / across
    low, high = ring.min(axis=0), ring.max(axis=0)
    number = np.maximum(np.ceil((high - low) / tile - 1e-9).astype(int), across)
    start = 0.5 * (low + high - number * tile)
    x, y = (start[k] + tile * np.arange(number[k] + 1) for k in (0, 1))
    shape = (len(y) - 1, len(x) - 1)
    centres = [0.5 * (edges[across:] + edges[:-across]) for edges in (x, y)]
    covered = Windows(*centres, size, tile_areas(ring, np.array([0, len(ring)]), x, y), shape, across,
                      np.ones((len(centres[1]), len(centres[0])), dtype=bool)).solids
    return Windows(*centres, size, tile_areas(vertices, offset, x, y), shape, across,
                   covered > (1 - 1e-9) * size ** 2)
