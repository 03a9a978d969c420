"""For pvpython: what each XDMF reader of ParaView makes of a file, as one JSON object on the last line of stdout.

usage: pvpython paraview_dump.py RUN.xdmf
"""
import json
import sys

from paraview import servermanager, simple

READERS = {"XDMF Reader": lambda name: simple.XDMFReader(FileNames=[name]),
           "Xdmf3 Reader S": lambda name: simple.Xdmf3ReaderS(FileName=[name]),
           "Xdmf3 Reader T": lambda name: simple.Xdmf3ReaderT(FileName=[name]),
           "by itself": simple.OpenDataFile}


def leaves(data):
    """The grids of nested blocks and pieces, in order; without those that a time does not have."""
    if data is None:
        return []
    if data.IsA("vtkMultiBlockDataSet"):
        return [leaf for i in range(data.GetNumberOfBlocks()) for leaf in leaves(data.GetBlock(i))]
    if data.IsA("vtkMultiPieceDataSet"):
        return [leaf for i in range(data.GetNumberOfPieces()) for leaf in leaves(data.GetPiece(i))]
    return [data]


def values(array):
    return [list(array.GetTuple(i)) for i in range(array.GetNumberOfTuples())]


def corners(grid, i):
    """GetCell gives one object for all cells of a kind: it is read before the next call."""
    cell = grid.GetCell(i)
    return cell.GetClassName(), [list(cell.GetPoints().GetPoint(j)[:2]) for j in range(cell.GetNumberOfPoints())]


def described(grid):
    cells = [corners(grid, i) for i in range(grid.GetNumberOfCells())]
    arrays = {data.GetArrayName(i): values(data.GetArray(i))
              for data in (grid.GetCellData(), grid.GetPointData()) for i in range(data.GetNumberOfArrays())}
    return {"types": sorted({name for name, _ in cells}), "cells": [points for _, points in cells], "arrays": arrays}


def block_names(data):
    return [data.GetMetaData(i).Get(data.NAME()) for i in range(data.GetNumberOfBlocks())]


def seen(reader):
    times = list(reader.TimestepValues)
    steps, names = [], []
    for time in times:
        reader.UpdatePipeline(time)
        data = servermanager.Fetch(reader)
        names.append(block_names(data))
        steps.append([described(grid) for grid in leaves(data)])
    return {"times": times, "names": names, "steps": steps}


print(json.dumps({name: seen(reader(sys.argv[1])) for name, reader in READERS.items()}))
