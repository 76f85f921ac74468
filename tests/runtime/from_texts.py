"""Robots and cells of files and of texts, as a command makes them once it has found the file."""

from pathlib import Path

from runtime.cell import cell
from runtime.cell.cell import CellSpec
from runtime.cell.cell_file import parse_cell_file, read_cell_file
from runtime.core.tomlfile import Source
from runtime.robot.files import loader, robot_file
from runtime.robot.model.spec import RobotSpec


def load_cell(path: Path) -> CellSpec:
    return cell.build(read_cell_file(path))


def parse_cell(source: Source, folder: Path | None = None) -> CellSpec:
    return cell.build(parse_cell_file(source, folder))


def parse_robot(source: Source) -> RobotSpec:
    return loader.build(robot_file.parse(source))
