"""`export --to dcc` against the structure that the schema of the DCC publishes.

usage: dcc_test.py SLIDEWAY SOURCE_DIR
The table is of dcc.xsd (https://ptb.de/dcc/v3.2.0/dcc.xsd; in what stands here 3.1.2 and 3.3.0 agree,
but for issueDate, which 3.1.2 lacks) and of SI_Format.xsd 2.1.0 (https://ptb.de/si).
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ET

PROGRAM, SOURCE = sys.argv[1:3]
SPACES = {"https://ptb.de/dcc": "dcc:", "https://ptb.de/si": "si:"}

# Children of an element in their order: a? may be left out, a+ is there once or more. Names without
# a prefix are of the element's own namespace.
CHILDREN = {
    "dcc:digitalCalibrationCertificate": "administrativeData measurementResults comment? document?",
    "dcc:administrativeData": "dccSoftware coreData items calibrationLaboratory respPersons customer "
                              "statements?",
    "dcc:dccSoftware": "software+",
    "dcc:usedSoftware": "software+",
    "dcc:software": "name release type? description?",
    "dcc:coreData": "countryCodeISO3166_1 usedLangCodeISO639_1+ mandatoryLangCodeISO639_1+ "
                    "uniqueIdentifier identifications? receiptDate? beginPerformanceDate "
                    "endPerformanceDate performanceLocation issueDate? previousReport?",
    "dcc:items": "name? equipmentClass? description? owner? identifications? item+",
    "dcc:item": "name equipmentClass? description? installedSoftwares? manufacturer model? "
                "identifications",
    "dcc:manufacturer": "name eMail? phone? fax? link? location? descriptionData?",
    "dcc:person": "name eMail? phone? fax? link? location? descriptionData?",
    "dcc:contact": "name eMail? phone? fax? link? location descriptionData?",
    "dcc:customer": "name eMail? phone? fax? link? location descriptionData?",
    "dcc:location": "further+",
    "dcc:identifications": "identification+",
    "dcc:identification": "issuer value name?",
    "dcc:calibrationLaboratory": "calibrationLaboratoryCode? contact",
    "dcc:respPersons": "respPerson+",
    "dcc:respPerson": "person description? role? mainSigner?",
    "dcc:statements": "statement+",
    "dcc:statement": "name? description? countryCodeISO3166_1? convention? traceable? norm? "
                     "reference? declaration? valid? date? period? respAuthority? conformity? data? "
                     "nonSIDefinition? nonSIUnit? location?",
    "dcc:measurementResults": "usedMethods? usedSoftware? measuringEquipments? influenceConditions? "
                              "measurementMetaData? measurementResult+",
    "dcc:measurementResult": "name description? usedMethods? usedSoftware? measuringEquipments? "
                             "influenceConditions? results measurementMetaData?",
    "dcc:usedMethods": "usedMethod+",
    "dcc:usedMethod": "name description? norm* reference*",
    "dcc:measuringEquipments": "name? measuringEquipment+",
    "dcc:measuringEquipment": "name equipmentClass? description? certificate? manufacturer? model? "
                              "identifications?",
    "dcc:influenceConditions": "influenceCondition+",
    "dcc:influenceCondition": "name description? status? certificate? data",
    "dcc:results": "result+",
    "dcc:result": "name description? data",
    "dcc:data": "text* quantity* list*",
    "dcc:quantity": "name? description? si:real",
    "dcc:text": "content+",
    "dcc:name": "content+",
    "dcc:description": "content+",
    "dcc:further": "content+",
    "dcc:declaration": "content+",
    "si:real": "label? quantityType? value unit dateTime? expandedUnc?",
    "si:expandedUnc": "uncertainty coverageFactor coverageProbability distribution?",
}
NOT_EMPTY = r"\S+(\s+\S+)*"
DATE = r"\d{4}-(0[1-9]|1[0-2])-(0[1-9]|[12]\d|3[01])"
DECIMAL = r"[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?"
VALUES = {
    "dcc:content": r"[^\0]*\S[^\0]*",
    "dcc:release": NOT_EMPTY,
    "dcc:type": "application|bios|driver|editor|firmware|library|os|other",
    "dcc:countryCodeISO3166_1": "[A-Z]{2}",
    "dcc:usedLangCodeISO639_1": "[a-z]{2}",
    "dcc:mandatoryLangCodeISO639_1": "[a-z]{2}",
    "dcc:uniqueIdentifier": NOT_EMPTY,
    "dcc:beginPerformanceDate": DATE,
    "dcc:endPerformanceDate": DATE,
    "dcc:issueDate": DATE,
    "dcc:performanceLocation": "laboratory|customer|laboratoryBranch|customerBranch|other",
    "dcc:issuer": "manufacturer|calibrationLaboratory|customer|owner|other",
    "dcc:value": NOT_EMPTY,
    "dcc:mainSigner": "true|false|1|0",
    "dcc:norm": NOT_EMPTY,
    "dcc:conformity": "pass|fail|conditionalPass|conditionalFail|noPass|noFail",
    "si:value": DECIMAL,
    "si:unit": r"\\micro(\\metre|\\radian)",
    "si:uncertainty": r"\+?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?",
    "si:coverageFactor": r"[1-9]\d*(\.\d+)?",
    "si:coverageProbability": r"0\.\d+|1(\.0*)?",
}


def name_of(element):
    space, name = element.tag[1:].split("}")
    return SPACES[space] + name


def order(element, rule):
    """The rule as a pattern over the names of the children, each with a blank behind it."""
    prefix = element.split(":")[0] + ":"
    out = ""
    for word in rule.split():
        name, times = re.fullmatch(r"([\w:]+)([?+*]?)", word).groups()
        out += f"({name if ':' in name else prefix + name} ){times}"
    return out


def breaches(element):
    name, children = name_of(element), [name_of(child) for child in element]
    out = []
    if name in CHILDREN:
        if not re.fullmatch(order(name, CHILDREN[name]), "".join(f"{child} " for child in children)):
            out.append(f"{name} holds {children}")
    elif not re.fullmatch(VALUES.get(name, "(?!)"), element.text or "") or children:
        out.append(f"{name} is {element.text!r} {children}")
    if not re.fullmatch("[a-z]{2}", element.get("lang", "en")):
        out.append(f"{name} has the language {element.get('lang')}")
    return out + [line for child in element for line in breaches(child)]


NEEDED = {"certificate": "2026-17", "country": "DE", "date": "2026-11-20", "machine": "LT-3",
          "serial": "4711", "manufacturer": "Lathe Works", "responsible": "A. <Person> & B",
          "laboratory": "Test room, 1 Main Street, Aachen", "customer": "Turned Parts Ltd, Bonn"}
MORE = {"workpiece": "disc", "instrument": "PGI", "instrument_serial": "12", "place": "customer",
        "calibrated": "2026-01-02", "conditions": "20.1 °C"}


class Certificate(unittest.TestCase):
    def certificate(self, about, keep, *options):
        """Of the example, with these keys of [about] and those of its tables that are kept."""
        example = pathlib.Path(SOURCE) / "problems/demo"
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            text = (example / "problem.toml").read_text(encoding="utf-8")
            tables = re.split(r"^(?=\[)", text, flags=re.M)
            tables = [table for table in tables if keep(table) and not table.startswith("[about]")]
            lines = ["[about]", *(f'{key} = "{value}"' for key, value in about.items()), ""]
            (folder / "problem.toml").write_text("".join(tables) + "\n" + "\n".join(lines),
                                                 encoding="utf-8")
            for file in example.glob("*.csv"):
                (folder / file.name).write_bytes(file.read_bytes())
            subprocess.run([PROGRAM, "identify", "problem.toml", "--no-trace", "--quiet", *options,
                            "--json", "result.json"], cwd=folder, check=True)
            subprocess.run([PROGRAM, "export", "result.json", "--to", "dcc", "--quiet",
                            "--out", "dcc.xml"], cwd=folder, check=True)
            return ET.parse(folder / "dcc.xml").getroot()

    def test_a_certificate_with_all_that_a_problem_can_say_is_of_the_schema(self):
        root = self.certificate(NEEDED | MORE, lambda table: True, "--date", "2026-11-23")
        self.assertEqual([], breaches(root))
        self.assertEqual("3.2.0", root.get("schemaVersion"))
        held = {name_of(element) for element in root.iter()}
        self.assertEqual(set(), {"dcc:issueDate", "dcc:statement", "dcc:measuringEquipment",
                                 "dcc:influenceCondition", "si:expandedUnc"} - held)

    def test_a_certificate_with_no_more_than_is_needed_is_of_the_schema(self):
        root = self.certificate(NEEDED, lambda table: not table.startswith("[tolerance]"))
        self.assertEqual([], breaches(root))

    def test_the_table_refuses_another_order_and_what_is_missing(self):
        root = self.certificate(NEEDED, lambda table: True)
        core = root.find("./{*}administrativeData/{*}coreData")
        core.append(core[0])
        self.assertEqual(1, len(breaches(root)))
        del core[0]
        self.assertEqual(1, len(breaches(root)))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
