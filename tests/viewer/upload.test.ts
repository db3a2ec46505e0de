import { chosen, kPart, send } from "@viewer/net/upload";
import { DatasetUpload } from "@viewer/ui/dataset_upload";

function file(path: string, bytes: number): File {
  const made = new File([new Uint8Array(bytes)], path.split("/").at(-1)!);
  Object.defineProperty(made, "webkitRelativePath", { value: path });
  return made;
}

/// A trainer that counts what it is sent; `refuse` may object to a request.
function trainer(refuse: (path: string) => string | undefined = () => undefined): { asked: string[]; bytes: () => number } {
  const asked: string[] = [];
  let bytes = 0, of = 0;
  vi.stubGlobal("fetch", async (path: string, init: RequestInit) => {
    init.signal?.throwIfAborted();
    asked.push(`${init.method} ${path}`);
    const refused = refuse(path);
    if (refused) return new Response(JSON.stringify({ refused }));
    if (path.endsWith("begin")) of = (JSON.parse(init.body as string) as { files: { bytes: number }[] }).files.reduce((sum, f) => sum + f.bytes, 0);
    if (init.method === "PUT") bytes += (init.body as Blob).size;
    return new Response(JSON.stringify({ upload: 3, bytes, of }));
  });
  return { asked, bytes: () => bytes };
}

afterEach(() => vi.unstubAllGlobals());

describe("upload of a dataset", () => {
  it("takes what lies directly in the folder, and names what it leaves out", () => {
    const folder = chosen([file("block/experiment.yaml", 5), file("block/a.csv", 5), file("block/.DS_Store", 5), file("block/old/b.csv", 5)]);
    expect(folder.dataset).toBe("block");
    expect(folder.files.map((f) => f.name)).toEqual(["experiment.yaml", "a.csv"]);
    expect(folder.left).toEqual([".DS_Store", "old/b.csv"]);
  });

  it("sends files in parts, one after another, and finishes", async () => {
    const { asked, bytes } = trainer();
    const shares: number[] = [];
    await send(chosen([file("block/experiment.yaml", 10), file("block/a.csv", 2 * kPart + 1), file("block/empty.txt", 0)]), (share) => shares.push(share), new AbortController().signal);
    expect(asked).toEqual(["POST /api/upload/begin", "PUT /api/upload/3/0/0", "PUT /api/upload/3/1/0", `PUT /api/upload/3/1/${kPart}`, `PUT /api/upload/3/1/${2 * kPart}`, "POST /api/upload/finish"]);
    expect(bytes()).toBe(2 * kPart + 11);
    expect(shares.at(-1)).toBe(1);
    expect(shares).toEqual([...shares].sort((a, b) => a - b));
  });

  it("takes back what was sent when it is cancelled or refused", async () => {
    const cancelled = new AbortController(), { asked } = trainer();
    await expect(send(chosen([file("block/a.csv", 3 * kPart)]), () => cancelled.abort(), cancelled.signal)).rejects.toThrow();
    expect(asked).toEqual(["POST /api/upload/begin", "PUT /api/upload/3/0/0", "POST /api/upload/cancel"]);
    const full = trainer((path) => (path.includes("/0/") ? "disk: found No space left on device" : undefined));
    await expect(send(chosen([file("block/a.csv", 10)]), () => undefined, new AbortController().signal)).rejects.toThrow("No space left");
    expect(full.asked.at(-1)).toBe("POST /api/upload/cancel");
  });

  it("says on the page what became of it", async () => {
    trainer((path) => (path.endsWith("begin") ? "files: found no experiment.yaml, expected a folder with experiment.yaml" : undefined));
    const panel = new DatasetUpload(), input = panel.element.querySelector("input")!, said = panel.element.querySelector("[role=status]")!;
    Object.defineProperty(input, "files", { value: [file("block/a.csv", 5)], configurable: true });
    input.dispatchEvent(new Event("change"));
    await vi.waitFor(() => expect(said.textContent).toContain("block was refused: files: found no experiment.yaml"));
    expect(panel.element.querySelector("progress")!.hidden).toBe(true);
    trainer();
    Object.defineProperty(input, "files", { value: [file("block/experiment.yaml", 5), file("block/more/x.csv", 5)], configurable: true });
    input.dispatchEvent(new Event("change"));
    await vi.waitFor(() => expect(said.textContent).toBe("block is there. Left out: more/x.csv."));
    expect(input.disabled).toBe(false);
  });
});
