// The questions asked over HTTP. Answers are typed by the message schema.
import type { SessionDetail, SessionList } from "../messages";

async function get<T>(path: string): Promise<T> {
  const answer = await fetch(path, { headers: { accept: "application/json" } });
  if (!answer.ok) throw new Error(`the trainer answered ${answer.status} to ${path}`);
  return (await answer.json()) as T;
}

export const sessions = (): Promise<SessionList> => get("/api/sessions");
export const session = (id: string): Promise<SessionDetail> => get(`/api/sessions/${encodeURIComponent(id)}`);
