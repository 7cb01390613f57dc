# The libraries of others, found once here in the root's scope so that every folder sees them.
# The Debian packages that hold them are listed in docker/packages/build.txt.

# What a program needs that links our core; bccskelConfig.cmake repeats this list.
set(BCCSKEL_CORE_PACKAGES Threads absl ZLIB zstd OpenEXR TIFF hwy nlohmann_json pugixml)
# What a program needs besides that links our client.
set(BCCSKEL_CLIENT_PACKAGES Protobuf gRPC meshoptimizer)

# The server keeps its jobs in SQLite; the sanitizers build that part without gRPC, too.
set(bccskel_packages ${BCCSKEL_CORE_PACKAGES} OpenSSL SQLite3)
if(BCCSKEL_BUILD_SERVER OR BCCSKEL_BUILD_CLIENT)
  list(APPEND bccskel_packages ${BCCSKEL_CLIENT_PACKAGES} CLI11)
endif()
if(BCCSKEL_BUILD_SERVER)
  list(APPEND bccskel_packages spdlog prometheus-cpp)
endif()
# Debian's Imath, which OpenEXR finds, complains of a Python library that nothing here needs.
set(CMAKE_MESSAGE_LOG_LEVEL NOTICE)
find_package(OpenEXR REQUIRED)
unset(CMAKE_MESSAGE_LOG_LEVEL)
foreach(package IN LISTS bccskel_packages)
  find_package(${package} REQUIRED)
endforeach()
# Servers that share a database; without it each has its own in SQLite.
find_package(PostgreSQL)
