# cmake -DSPIRV=FILE -DNAME=NAME -DHEADER=FILE -P embed_spirv.cmake: SPIR-V words as a C++ array.
file(READ ${SPIRV} bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${bytes}")
file(WRITE ${HEADER} "#include <cstdint>\nstatic const std::uint32_t ${NAME}[] = {${words}};\n")
