"""Which kind of run a base file describes. All kinds have the same functions (see biaxial_test.py), so that campaigns
and studies plan, run and tabulate them alike."""
from . import biaxial_test, laboratory_test
from ..text_yaml import read_mapping


def kind_of(base):
    """A laboratory test names itself by its key `test`; any other file is a scene."""
    return laboratory_test if "test" in read_mapping(base) else biaxial_test
