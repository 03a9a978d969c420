"""Micromechanical measures of a contact state and of a run, on plain arrays. Needs numpy and h5py alone.

    from rockbreak import measures
    frame = measures.read_frame("runs/demo/frames/000040.h5")
    fit = measures.fit_anisotropies(frame.normal, frame.normal_force, frame.shear_force)

The table of functions stands in pipeline/README.md, Measures.
"""
from .breakage import (Breakages, Cracks, Families, Generation, angle_between, arrested_cracks, breakages_by_strain,
                       breakages_of, direction_rose, families, generations, read_breakages)
from .chains import ForceChains, find_chains, force_chains
from .classes import force_classes, large_displacements, read_contact_state, stress_classes
from .displacements import (Motion, affine_motion, ancestors, displacement_class, displacements_since, frame_motion,
                            local_gradients, rotation_of, rotations_since, strain_of)
from .energy import Energies, energies
from .fabric import (Anisotropies, PolarHistogram, fit_anisotropies, frame_anisotropies, polar_histogram,
                     sin_phi_of_stress)
from .forces import (ForceDistribution, StrongShare, Uniformity, deviator_by_force, exponential_tail,
                     force_distribution, power_of_weak, strong_share, tail_variation, uniformity)
from .frame import Frame, Split, read_frame, read_split
from .gradation import (FractalFit, Gradation, einav, equivalent_diameter, fractal_dimension,
                        fractal_dimension_by_mass, frame_gradation, gradation, hardin, longest_diameter, marsal,
                        sieve_size, smallest_piece, standard_sieves)
from .local_fields import Windows, windows, windows_of
from .stresses import (assembly_stress, class_of, element_stresses, frame_stresses, particle_stresses,
                       principal_stresses)
from .void_ratio import TileAreas, VoidRatios, tile_areas, void_ratios
