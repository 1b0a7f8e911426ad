// A client of an OPC UA server by node-opcua: node node_opcua_reader.mjs URL
// It writes a line of JSON for the machine's tree, then one for each change of the program's state
// and each alert, until its stdin ends.
import { createRequire } from "node:module";
const require = createRequire(process.cwd() + "/");
const { AttributeIds, NodeClass, OPCUAClient, TimestampsToReturn, constructEventFilter, makeBrowsePath } =
  require("node-opcua-client");

const tell = (message) => process.stdout.write(JSON.stringify(message) + "\n");
const plain = (value) => {
  if (value?.text !== undefined) return value.text;
  if (value?.displayName !== undefined) return value.displayName.text;
  if (ArrayBuffer.isView(value)) return Array.from(value);
  return value?.namespace !== undefined ? value.toString() : value;
};

const client = OPCUAClient.create({ endpointMustExist: false });
await client.connect(process.argv[2]);
const session = await client.createSession();
const spaces = await session.readNamespaceArray();
const index = (uri) => spaces.indexOf(uri);
const machinery = index("http://opcfoundation.org/UA/Machinery/");
const tool = index("http://opcfoundation.org/UA/MachineTool/");
const own = index("urn:motionfmu:machine");

const read = async (nodeId) => plain((await session.read({ nodeId, attributeId: AttributeIds.Value })).value.value);
const tree = async (nodeId) => {
  const found = {};
  const { references } = await session.browse({
    nodeId, referenceTypeId: "Aggregates", includeSubtypes: true, browseDirection: 0, resultMask: 63 });
  for (const part of references) {
    const below = await tree(part.nodeId);
    const name = part.browseName.name;
    if (part.nodeClass === NodeClass.Variable) found[name] = await read(part.nodeId);
    else found[name] = { is: part.typeDefinition.toString(), ...below };
    if (part.nodeClass === NodeClass.Variable && Object.keys(below).length) found[`${name}/`] = below;
  }
  return found;
};

const machines = await session.browse(`ns=${machinery};i=1001`);
const machine = machines.references.find((r) => r.browseName.namespaceIndex === own).nodeId;
tell({ tree: await tree(machine), types: await read("ns=0;i=2255") });

const subscription = await session.createSubscription2({
  requestedPublishingInterval: 20, requestedLifetimeCount: 1000, requestedMaxKeepAliveCount: 10,
  maxNotificationsPerPublish: 100, publishingEnabled: true, priority: 1 });
const path = `/${tool}:Production/${tool}:ActiveProgram/${tool}:State/CurrentState`;
const state = (await session.translateBrowsePath(makeBrowsePath(machine, path))).targets[0].targetId;
const watched = await subscription.monitor(
  { nodeId: state, attributeId: AttributeIds.Value },
  { samplingInterval: 0, discardOldest: true, queueSize: 100 }, TimestampsToReturn.Both);
watched.on("changed", (data) => tell({ state: plain(data.value.value) }));
const fields = ["EventType", "SourceName", "Message", "Severity", "ActiveState.Id", `${tool}:ErrorCode`];
const events = await subscription.monitor(
  { nodeId: "ns=0;i=2253", attributeId: AttributeIds.EventNotifier },
  { samplingInterval: 0, discardOldest: true, queueSize: 100, filter: constructEventFilter(fields) },
  TimestampsToReturn.Both);
events.on("changed", (values) => tell({ alert: values.map((v) => plain(v.value)) }));

process.stdin.resume();
process.stdin.on("end", async () => {
  await session.close();
  await client.disconnect();
  process.exit(0);
});
