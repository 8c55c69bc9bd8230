# Writes a header with one constant per list of libraries: the hash of their contents. Usage:
# cmake -DOUT=FILE -DRECORDING="A;B" -DPHOTOMETRIC="C" -DRUN="D;E" -P library_ids.cmake
function(hash_of RESULT)
  set(ALL "")
  foreach(FILE ${ARGN})
    file(SHA256 ${FILE} ONE)
    string(APPEND ALL ${ONE})
  endforeach()
  string(SHA256 HASH "${ALL}")
  string(SUBSTRING ${HASH} 0 16 HASH)
  set(${RESULT} ${HASH} PARENT_SCOPE)
endfunction()
hash_of(RECORDING_HASH ${RECORDING})
hash_of(PHOTOMETRIC_HASH ${PHOTOMETRIC})
hash_of(RUN_HASH ${RUN})
file(WRITE ${OUT} "#pragma once

namespace evit {
inline constexpr char kRecordingLibraries[] = \"${RECORDING_HASH}\";
inline constexpr char kPhotometricLibraries[] = \"${PHOTOMETRIC_HASH}\";
inline constexpr char kRunLibraries[] = \"${RUN_HASH}\";
}  // namespace evit
")
