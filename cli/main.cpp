#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "adamas/text.h"
#include "cli/command_line.h"
#include "cli/exit_status.h"
#include "cli/interrupt.h"
#include "cli/usage.h"

namespace {

using adamas::cli::kDone, adamas::cli::kFailed, adamas::cli::kIncomplete, adamas::cli::kInterrupted,
    adamas::cli::kWrongUsage;

/// Prints the message as one line on stderr.
void complain(std::string text) {
  text.erase(text.find_last_not_of(" \r\n") + 1);
  std::fprintf(stderr, "adamas: error: %s\n", adamas::visible_text(text).c_str());
}

int usage_status(const std::string& message, const std::string& command) {
  complain(message);
  std::fprintf(stderr, "Try 'adamas%s%s --help'.\n", command.empty() ? "" : " ", command.c_str());
  return kWrongUsage;
}

/// Returns what is said where memory runs out.
std::string too_little(const adamas::cli::Session& session) {
  if (session.memory == 0) return "expected enough memory, found too little";
  return "expected to take at most " + adamas::bytes_text(static_cast<double>(session.memory)) +
         " of memory, found that more is needed: choose a part by --region, coarser data, greater errors, or "
         "another limit by --memory";
}

/// Runs the command. Error messages name the input and, where memory runs out, the stage of the work.
void run_command(adamas::cli::Session& session) {
  const adamas::OutputSet& outputs = session.outputs;
  try {
    session.run();
  } catch (const adamas::Error& e) {
    if (e.kind() == adamas::ErrorKind::kCancelled || e.kind() == adamas::ErrorKind::kUsage) throw;
    throw adamas::Error(outputs.naming_input(e.what()), e.kind());
  } catch (const std::bad_alloc&) {
    const std::string& stage = session.console.stage();
    throw adamas::Error(outputs.naming_input((stage.empty() ? "" : stage + ": ") + too_little(session)));
  } catch (const std::exception& e) {
    throw adamas::Error(outputs.naming_input(e.what()));
  }
}

int run(adamas::cli::CommandLine& command_line, adamas::cli::Session& session, int argc, char** argv) {
  try {
    if (command_line.parse(argc, argv)) {
      run_command(session);
      session.console.clear();
    }
    session.console.flush();
    return session.console.incomplete() ? kIncomplete : kDone;
  } catch (const adamas::Error& e) {
    if (e.kind() != adamas::ErrorKind::kUsage) throw;
    return usage_status(e.what(), command_line.named_command());
  }
}

/// Returns the message of a run that ends early, with its lasting changes.
std::string with_kept(const std::string& message, const adamas::cli::Session& session) {
  return session.kept.empty() ? message : message + "; " + session.kept;
}

/// Runs the program and returns its exit status, whatever is thrown.
int run_to_the_end(adamas::cli::CommandLine& command_line, adamas::cli::Session& session, int argc,
                   char** argv) {
  try {
    return run(command_line, session, argc, argv);
  } catch (const adamas::Cancelled&) {
    session.console.clear();
    std::fprintf(stderr, "adamas: %s\n", with_kept("cancelled", session).c_str());
    return kInterrupted;
  } catch (const std::bad_alloc&) {
    session.console.clear();
    complain(with_kept(too_little(session), session));
  } catch (const std::exception& e) {
    session.console.clear();
    complain(with_kept(e.what(), session));
  } catch (...) {
    session.console.clear();
    complain("stopped for a reason that is not known");
  }
  return kFailed;
}

}  // namespace

int main(int argc, char** argv) {
  adamas::cli::occupy_closed_streams();
  adamas::cli::catch_signals();
  adamas::cli::Session session;
  adamas::cli::CommandLine command_line(session);
  return run_to_the_end(command_line, session, argc, argv);
}
