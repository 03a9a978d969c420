"""Force chains: quasi-linear rows of highly stressed particles (Peters, Muthuswamy, Wibowo and Tordesillas 2005).

A particle is highly stressed if its major principal stress is above the mean over all particles. Two of them that touch
are linked if the line between their centres is within `angle` (45 degrees there) of the major principal direction of
each. Three or more linked particles are a chain. Each particle goes on at most once to either side along its stress, so
that a chain does not branch: where several links leave one side, the one with the smallest angle (the larger of those
at its two ends) comes first. Boundary particles belong to no chain: `dem` has no forces among them, so that their
stress lacks a part.
"""
from dataclasses import dataclass

import numpy as np

from .stresses import frame_stresses, principal_stresses

ANGLE = np.pi / 4
SHORTEST = 3  # particles


@dataclass(frozen=True)
class ForceChains:
    """K chains of P particles in all, joined by P - K contacts; those with the lowest row of an end come first."""
    members: np.ndarray   # P rows of particles, in order along each chain
    offset: np.ndarray    # K + 1; first row of each chain in `members`
    contacts: np.ndarray  # P - K rows of contacts, chain after chain
    length: np.ndarray    # K along the centres [m]
    span: np.ndarray      # K x 2 from the first centre to the last [m]
    stressed: np.ndarray  # N bool: highly stressed
    threshold: float      # [Pa] of the major principal stress

    def __len__(self):
        return len(self.offset) - 1

    @property
    def sizes(self):
        """K numbers of particles."""
        return np.diff(self.offset)

    @property
    def of_particle(self):
        """N numbers of chains; -1: in none."""
        chain = np.full(len(self.stressed), -1)
        chain[self.members] = np.repeat(np.arange(len(self)), self.sizes)
        return chain

    @property
    def straightness(self):
        """K distances of the ends / lengths."""
        return np.linalg.norm(self.span, axis=1) / self.length


def find_chains(position, stress, a, b, angle=ANGLE, threshold=None, shortest=SHORTEST, candidates=None):
    """ForceChains of N particles: centroids (N x 2) [m], stresses (N x 3: xx, yy, xy) [Pa]; `a`, `b`: rows of the
    particles of C loaded contacts.

    `threshold` [Pa]: None for the mean major principal stress of the `candidates` (N bool, default: all), which alone
    can be members. `angle` [rad].
    """
    count = len(position)
    candidates = np.ones(count, dtype=bool) if candidates is None else candidates
    major, _, direction = principal_stresses(stress)
    if threshold is None:
        threshold = float(major[candidates].mean()) if candidates.any() else 0.0
    stressed = candidates & (major > threshold)
    axis = np.column_stack([np.cos(direction), np.sin(direction)])
    link = np.flatnonzero(stressed[a] & stressed[b])
    i, j = a[link], b[link]
    branch = position[j] - position[i]
    branch = branch / np.linalg.norm(branch, axis=1)[:, None]
    along_i, along_j = np.einsum("ij,ij->i", axis[i], branch), np.einsum("ij,ij->i", axis[j], branch)
    worse = np.minimum(np.abs(along_i), np.abs(along_j))
    good = np.flatnonzero(worse >= np.cos(angle) * (1 - 1e-12))
    good = good[np.argsort(-worse[good], kind="stable")]
    # Two places at each particle: ahead and behind, along its own axis.
    place = np.column_stack([2 * i + (along_i < 0), 2 * j + (along_j > 0)])
    taken = {}  # place -> (place at the other end, contact)
    for k in good.tolist():
        p, q = place[k].tolist()
        if p not in taken and q not in taken:
            taken[p], taken[q] = (q, int(link[k])), (p, int(link[k]))
    rows, contacts = _walks(taken, shortest)
    members = np.array([row for walk in rows for row in walk], dtype=int)
    offset = np.cumsum([0] + [len(walk) for walk in rows])
    step = np.linalg.norm(np.diff(position[members], axis=0), axis=1) if len(members) else np.zeros(0)
    to = np.concatenate([[0.0], np.cumsum(step)])
    ends = members[offset[1:] - 1], members[offset[:-1]]
    return ForceChains(members, offset, np.array([c for walk in contacts for c in walk], dtype=int),
                       to[offset[1:] - 1] - to[offset[:-1]], position[ends[0]] - position[ends[1]], stressed, threshold)


def _walks(taken, shortest):
    """Particles and contacts of every walk through `taken` with enough particles. A closed one starts at its first."""
    particles = sorted({place // 2 for place in taken})
    ends = [p for p in particles if (2 * p in taken) != (2 * p + 1 in taken)]
    seen, rows, contacts = set(), [], []
    for start in ends + particles:
        if start in seen:
            continue
        place = 2 * start if 2 * start in taken else 2 * start + 1
        walk, links = [start], []
        seen.add(start)
        while place in taken:
            arrived, contact = taken[place]
            if arrived // 2 in seen:
                break
            links.append(contact)
            walk.append(arrived // 2)
            seen.add(arrived // 2)
            place = arrived ^ 1  # out at the other side
        if len(walk) >= shortest:
            rows.append(walk)
            contacts.append(links)
    return rows, contacts


def force_chains(frame, stress=None, angle=ANGLE, threshold=None, shortest=SHORTEST):
    """find_chains in a Frame, without its boundary particles; `stress` (N x 3) [Pa]: None for the virial."""
    loaded = frame.normal_force > 0
    chains = find_chains(frame.position, frame_stresses(frame) if stress is None else stress, frame.a[loaded],
                         frame.b[loaded], angle, threshold, shortest, ~frame.boundary)
    contacts = np.flatnonzero(loaded)[chains.contacts]
    return ForceChains(chains.members, chains.offset, contacts, chains.length, chains.span, chains.stressed,
                       chains.threshold)
