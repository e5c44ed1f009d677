# Writes OUTPUT, a source file that says of which commit SOURCE is; a file that says so already is left as it is.
# cmake -D SOURCE=folder -D OUTPUT=file.cpp [-D COMMIT=name] -P commit.cmake
if(NOT COMMIT AND EXISTS ${SOURCE}/.git) # or git would find the repository of a folder above
    execute_process(COMMAND git -C ${SOURCE} describe --always --dirty
        OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT COMMIT)
    set(COMMIT unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#include \"commands/commands.h\"\nconst char* const vkpm::commit = \"${COMMIT}\";\n")
