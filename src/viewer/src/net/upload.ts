// A folder of measurements on its way to the trainer: begun with the list of its files, sent in parts, put in its place at the end.
import { put, post } from "./api";

export const kPart = 1024 * 1024; // [byte], as the server takes them

interface UploadStatus { upload: number; bytes: number; of: number }

export interface Chosen {
  dataset: string;
  files: File[];
  left: string[]; // names of what is not sent: hidden files, and what lies in folders below
}

/// Of the files of a chosen folder those that lie directly in it.
export function chosen(all: Iterable<File>): Chosen {
  const result: Chosen = { dataset: "", files: [], left: [] };
  for (const file of all) {
    const [folder, ...below] = file.webkitRelativePath.split("/");
    result.dataset ||= folder;
    if (below.length === 1 && !file.name.startsWith(".")) result.files.push(file);
    else result.left.push(below.join("/"));
  }
  return result;
}

/// Sends what was chosen; `told` hears the share that is there. A failure or an abort takes back what was sent, and is thrown.
export async function send(folder: Chosen, told: (share: number) => void, signal: AbortSignal): Promise<void> {
  const { dataset, files } = folder;
  const begun = await post<UploadStatus>("/api/upload/begin", { dataset, files: files.map(({ name, size }) => ({ name, bytes: size })) });
  const upload = { upload: begun.upload };
  try {
    for (const [n, file] of files.entries()) {
      for (let at = 0; at < file.size; at += kPart) {
        signal.throwIfAborted();
        const { bytes, of } = await put<UploadStatus>(`/api/upload/${begun.upload}/${n}/${at}`, file.slice(at, at + kPart), signal);
        told(of > 0 ? bytes / of : 1);
      }
    }
    signal.throwIfAborted();
    await post("/api/upload/finish", upload);
  } catch (error) {
    await post("/api/upload/cancel", upload).catch(() => undefined); // the trainer may be gone: it forgets by itself
    throw error;
  }
}
