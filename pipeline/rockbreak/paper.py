"""Published numbers to set beside ours: Raisianzadeh et al. (2019), biaxial tests on 1194 angular particles.

Numbers of particles and contacts are sums over the classes of Tables 2 and 3 (stress classes count every particle,
force classes every contact).
"""

PARTICLES = 1194

# Confining pressure of 2 MPa (Table 2); axial strain -> number.
PARTICLES_2MPA_BREAKABLE = {0.0: 1194, 0.07: 1344, 0.10: 1411, 0.173: 1513}
CONTACTS_2MPA = {
    False: {0.0: 2015, 0.07: 1987, 0.10: 1947, 0.173: 1920},
    True: {0.0: 2015, 0.07: 2256, 0.10: 2338, 0.173: 2503},
}

# Table 4; confining pressure [Pa] -> void ratio at the end of the test.
FINAL_VOID_RATIO = {
    False: {0.5e6: 0.360, 1e6: 0.351, 2e6: 0.336, 4e6: 0.314},
    True: {0.5e6: 0.358, 1e6: 0.339, 2e6: 0.316, 4e6: 0.288},
}
INITIAL_VOID_RATIO = 0.30


def applies_to(case):
    """True for the paper's own assembly at 2 MPa, whose numbers may be drawn beside ours."""
    particles = (case.get("assembly") or {}).get("particles")
    pressure = (case.get("preparation") or {}).get("confining_pressure")
    return particles == PARTICLES and pressure == 2e6
