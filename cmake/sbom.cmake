# What the program is made of, as SPDX 2.3: the table of THIRD_PARTY.md with the installed versions.
find_program(SLIDEWAY_DPKG_QUERY dpkg-query)
mark_as_advanced(SLIDEWAY_DPKG_QUERY)

function(slideway_sbom out)
  string(TIMESTAMP created "%Y-%m-%dT%H:%M:%SZ" UTC)  # heeds SOURCE_DATE_EPOCH
  set(packages "")
  set(relations "")
  file(STRINGS ${PROJECT_SOURCE_DIR}/THIRD_PARTY.md rows REGEX "^\\| .* \\| .* \\| .* \\| .* \\|$")
  list(POP_FRONT rows)  # the headings
  set(number 0)
  foreach(row IN LISTS rows)
    string(REGEX MATCH "^\\| (.*) \\| (.*) \\| (.*) \\| (.*) \\|$" row "${row}")
    if(row STREQUAL "")
      message(FATAL_ERROR "THIRD_PARTY.md: a row of the table has a semicolon")
    endif()
    set(name "${CMAKE_MATCH_1}")
    set(package "${CMAKE_MATCH_2}")
    set(licence "${CMAKE_MATCH_3}")
    set(version NOASSERTION)
    if(SLIDEWAY_DPKG_QUERY)
      execute_process(COMMAND ${SLIDEWAY_DPKG_QUERY} -W -f=\${Version} ${package}
                      OUTPUT_VARIABLE version ERROR_QUIET RESULT_VARIABLE missing)
      if(missing)
        set(version NOASSERTION)
      endif()
    endif()
    math(EXPR number "${number} + 1")
    string(APPEND packages ",
    {\"SPDXID\": \"SPDXRef-part-${number}\", \"name\": \"${name}\", \"versionInfo\": \"${version}\",
     \"downloadLocation\": \"NOASSERTION\", \"filesAnalyzed\": false,
     \"licenseConcluded\": \"${licence}\", \"licenseDeclared\": \"${licence}\",
     \"copyrightText\": \"NOASSERTION\", \"sourceInfo\": \"Debian package ${package}\"}")
    string(APPEND relations ",
    {\"spdxElementId\": \"SPDXRef-slideway\", \"relationshipType\": \"DEPENDS_ON\",
     \"relatedSpdxElement\": \"SPDXRef-part-${number}\"}")
  endforeach()
  file(CONFIGURE OUTPUT ${out} @ONLY CONTENT [=[{
  "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT",
  "name": "slideway-@PROJECT_VERSION@",
  "documentNamespace": "https://spdx.org/spdxdocs/slideway-@PROJECT_VERSION@-@created@",
  "creationInfo": {"created": "@created@", "creators": ["Organization: The slideway authors"]},
  "packages": [
    {"SPDXID": "SPDXRef-slideway", "name": "slideway", "versionInfo": "@PROJECT_VERSION@",
     "downloadLocation": "NOASSERTION", "filesAnalyzed": false,
     "licenseConcluded": "BSD-3-Clause", "licenseDeclared": "BSD-3-Clause",
     "copyrightText": "Copyright (c) 2026, the slideway authors"}@packages@],
  "relationships": [
    {"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES",
     "relatedSpdxElement": "SPDXRef-slideway"}@relations@]
}
]=])
endfunction()

slideway_sbom(${PROJECT_BINARY_DIR}/slideway.spdx.json)
