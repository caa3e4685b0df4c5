// What a program does with its process before anything else, and what of the machine is left to it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace cloth {

/// Standard input, output and error that the caller closed would go to the next files opened: messages would
/// be written into results. They become /dev/null, opened so that writing to it fails and is seen. A closed
/// pipe and a file size limit become errors of write instead of signals.
void settle_standard_streams();

/// What ends a thread by an uncaught exception says so on standard error and ends the process with
/// an exit code, not by a signal: `memory` where memory ran out, `defect` otherwise. `program` stands before
/// the message.
void end_by_exit_code(const char* program, int memory, int defect);

/// Notes the size of a request for memory that the system refused, which std::bad_alloc does not carry:
/// messages then name it. For operator new of a program.
void note_refused_memory(std::size_t bytes);

/// What an exception that ended some work says to people. A defect is one that no input, no file and no lack
/// of memory should bring about.
struct Failure {
  std::string text;
  bool is_defect = false;
};

/// Of the exception being handled: to be called within `catch (...)`.
Failure failure_in_hand();

/// Bytes that this process may still ask for: the least of free memory, limits of the process (ulimit -v) and
/// of its control group. Nothing where the system does not say.
std::optional<double> available_memory();

/// The machine's name; empty where the system does not tell.
std::string host_name();

}  // namespace cloth
