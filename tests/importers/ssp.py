"""Writes an SSP file: components with all their outputs, the inputs that are connected, and the connections."""

import zipfile
from pathlib import Path

import fmpy

NAMESPACES = 'xmlns:ssd="http://ssp-standard.org/SSP1/SystemStructureDescription" xmlns:ssc="http://ssp-standard.org/SSP1/SystemStructureCommon"'


def write(path, fmus, connections):
    """`fmus`: path by component name; `connections`: pairs of "component.variable", from output to input."""
    components = "".join(_component(name, fmu, connections) for name, fmu in fmus.items())
    lines = "".join(_connection(*source.split(".", 1), *sink.split(".", 1)) for source, sink in connections)
    structure = (f'<?xml version="1.0" encoding="UTF-8"?>\n<ssd:SystemStructureDescription {NAMESPACES} version="1.0" name="trains">'
                 f'<ssd:System name="system"><ssd:Elements>{components}</ssd:Elements>'
                 f"<ssd:Connections>{lines}</ssd:Connections></ssd:System>"
                 '<ssd:DefaultExperiment startTime="0.0" stopTime="0.01"/></ssd:SystemStructureDescription>')
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("SystemStructure.ssd", structure)
        for fmu in fmus.values():
            archive.write(fmu, f"resources/{Path(fmu).name}")
    return str(path)


def _component(name, fmu, connections):
    # Inputs without a connection keep their start values: FMPy sets each connector, and those from nowhere to 0.
    connected = {sink for _, sink in connections}
    variables = [v for v in fmpy.read_model_description(str(fmu)).modelVariables
                 if v.causality == "output" or f"{name}.{v.name}" in connected]
    connectors = "".join(f'<ssd:Connector name="{v.name}" kind="{v.causality}"><ssc:Real/></ssd:Connector>' for v in variables)
    return (f'<ssd:Component name="{name}" type="application/x-fmu-sharedlibrary" source="resources/{Path(fmu).name}">'
            f"<ssd:Connectors>{connectors}</ssd:Connectors></ssd:Component>")


def _connection(start, output, end, input_):
    return (f'<ssd:Connection startElement="{start}" startConnector="{output}" endElement="{end}" endConnector="{input_}"/>')
